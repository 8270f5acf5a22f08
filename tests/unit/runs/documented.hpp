// Compares quantities with the page of the manual that must contain their table.
#pragma once

#include <keeler/files/files.hpp>
#include <keeler/quantities/views.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

namespace keeler::test {

inline void check_documented(const std::vector<quantities::Quantity>& quantities, const std::string& page) {
  std::set<std::string> names;
  for (const quantities::Quantity& quantity : quantities) {
    CAPTURE(quantity.name);
    CHECK(!quantity.meaning.empty());
    CHECK(quantity.meaning.find('|') == std::string::npos); // it would end a cell of the table
    for (const quantities::UnitSystem system : quantity.systems())
      CHECK(names.insert(quantity.full_name(system)).second);
  }
  const std::string table = markdown_of(quantities);
  INFO(page << " must hold this table:\n" << table);
  CHECK(files::read_text(KEELER_SOURCE_DIR "/" + page).find(table) != std::string::npos);
}

} // namespace keeler::test
