"""Tables for papers: LaTeX with the packages booktabs and siunitx left out, so that any class takes them."""
from .measures import MEASURES, number

ESCAPES = {"\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
           "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "×": r"$\times$", "⁻": r"$^{-}$", "³": r"$^{3}$"}


def escaped(text):
    return "".join(ESCAPES.get(c, c) for c in text).replace(r"$^{-}$$^{3}$", r"$^{-3}$")


def value(name, row, best):
    text = number(name, row["mean"])
    if float(row["half_width"] or 0) > 0:
        text += rf" \pm {number(name, row['half_width'])}"
    return rf"$\mathbf{{{text}}}$" if best else f"${text}$"


def latex(caption, axes, keys, names, cells, best):
    """A tabular with a row for each key (scene, graph, axes...) and a column for each measure.

    cells: (key, measure) -> row of the table; best: measure -> its best rows.
    """
    head = ["scene", "graph", *axes, *(MEASURES[n].heading for n in names)]
    lines = [f"% {caption}", rf"\begin{{tabular}}{{{'l' * (2 + len(axes))}{'r' * len(names)}}}", r"\hline",
             " & ".join(map(escaped, head)) + r" \\", r"\hline"]
    for key in keys:
        row = [escaped(part) for part in key]
        for name in names:
            found = cells.get((key, name))
            row.append(value(name, found, any(found is b for b in best[name])) if found and found["mean"] else "--")
        lines.append(" & ".join(row) + r" \\")
    lines += [r"\hline", r"\end{tabular}"]
    lines += [f"% {MEASURES[n].heading}: {MEASURES[n].better}" for n in names]
    return "\n".join(lines) + "\n"
