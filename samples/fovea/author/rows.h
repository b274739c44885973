// Tables and values as the commands print them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fovea/pass.h"

namespace fovea::cli {

// Name, properties, doc.
using TableRow = std::array<std::string, 3>;
// In columns, below an empty line and the title; nothing if there are no rows.
void printRows(const std::string& title, const std::vector<TableRow>& rows);

// "1000 (1 to 4096, whole)": a value, and what else is allowed.
std::string describeValue(std::string value, const graph::ParameterSpec& spec);
std::string printValue(const graph::Value& value);

}  // namespace fovea::cli
