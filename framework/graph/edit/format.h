// The stable layout of graph files, so that versions of a file differ where their meaning does.
#pragma once

#include <string>
#include <string_view>

namespace fovea::graph {

// The same graph in the stable layout: what fits into a line is on one line, everything else has a line for each member,
// and the keys of the document and of passes have a fixed order. Passes, inputs and values keep theirs. The result of a
// result is itself. Throws Error(BadInput) if the text is no JSON. `file`: its name in messages.
std::string formatText(std::string_view text, std::string_view file);

}  // namespace fovea::graph
