// Reads tables of numbers as eye trackers, spreadsheets and fovea write them.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/error.h"

namespace fovea::scene {

// What a table has to be.
struct CsvKind {
  std::string name;                  // "a table of gazes"
  std::vector<std::string> columns;  // that it may have, in lower case
  std::vector<std::string> required;
  std::string start;  // how a header may begin, for messages: "t,x,y,valid"
};

// Columns may be separated by commas, semicolons or tabs; lines end with CR, LF or both; cells may be in quotes (RFC
// 4180), and numbers have decimal points or commas. Empty lines and those that begin with # are left out.
class CsvTable {
 public:
  CsvTable(std::string file, CsvKind kind) : file_(std::move(file)), kind_(std::move(kind)) {}

  // Calls `row` for every row, which asks for its numbers. Throws Error(BadInput) with every mistake, up to 20.
  void read(std::string_view text, const std::function<void()>& row);
  bool has(const std::string& column) const;
  // Of the row; nothing if the cell is empty, the column is missing, or it is a mistake.
  std::optional<double> number(const std::string& column, double min, double max);
  void mistake(const std::string& message, const std::string& remedy = {});
  size_t mistakes() const { return errors_.list().size(); }
  void throwIfWrong() const { errors_.throwIfErrors(); }  // of mistakes that were told after read()

 private:
  void readHeader(std::string_view text);
  void readRow(std::string_view text, const std::function<void()>& row);

  std::string file_;
  CsvKind kind_;
  std::vector<std::string> columns_;
  std::map<std::string, std::string> row_;
  Diagnostics errors_;
  int line_ = 0;
  char separator_ = ',';
  bool points_ = false, commas_ = false;  // whether numbers had decimal points, and decimal commas
};

// The text of such a file. Throws Error(BadInput) for one that cannot be read or is larger than any table.
std::string readTableText(const std::filesystem::path& file);

}  // namespace fovea::scene
