"""The look of the page: light, dark, and on paper."""

STYLE = """:root{color-scheme:light dark;--text:#1b1b1f;--back:#fff;--soft:#f3f3f6;--line:#ddd;--faint:#5b5b66;--strong:#889;--warn:#fff3d6}
@media (prefers-color-scheme:dark){:root{--text:#e4e4e9;--back:#16161a;--soft:#26262c;--line:#3a3a42;--faint:#a2a2ad;--strong:#77778a;--warn:#4a3b12}}
body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:var(--text);background:var(--back)}
table{border-collapse:collapse;margin:1em 0;font-size:13px}th,td{border-bottom:1px solid var(--line);padding:.3em .7em;text-align:right;vertical-align:top}
th{background:var(--soft)}td:first-child,th:first-child,.names td:nth-child(2),.names th:nth-child(2){text-align:left}small{color:var(--faint);display:block}
figure{display:inline-block;margin:.4em;vertical-align:top;max-width:100%}figcaption{font-size:13px;color:var(--faint)}.pixels{image-rendering:pixelated}
figure img{background:#fff;border-radius:4px}img{max-width:100%}.grid{overflow-x:auto}.num td{white-space:nowrap}.num th{vertical-align:bottom;max-width:7.5em}
.steps th{max-width:none}.best{font-weight:bold}.first td{border-top:2px solid var(--strong)}
.pics td{border:0;padding:.15em;text-align:left;white-space:normal}.pics td:first-child{max-width:7em;color:var(--faint)}.pics img{display:block;max-width:none}
td.text{text-align:left;white-space:normal}.warn{background:var(--warn);padding:.6em 1em;border-radius:6px}code{background:var(--soft);padding:0 .3em}
@media print{:root{--text:#000;--back:#fff;--soft:#eee;--line:#999;--faint:#333;--warn:#eee}body{max-width:none;margin:0;font-size:10pt}
.grid{overflow:visible}figure,tr,h2,h3{break-inside:avoid}h2,h3{break-after:avoid}table{font-size:8pt}.pics{table-layout:fixed;width:100%}.pics img{max-width:100%;height:auto}}"""
