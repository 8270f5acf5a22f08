// The field table: the single list of the state to store. Each component declares its whole state as fields (name,
// type, location, unit, meaning), and readers and writers use only the table. New state needs one more line in its
// owner's list, and then neither a checkpoint nor a restart can omit it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace keeler {

enum class FieldType { float64, float32, int64, uint64, uint32 };

template<class T> constexpr FieldType field_type() {
  if constexpr (std::is_same_v<T, double>)
    return FieldType::float64;
  else if constexpr (std::is_same_v<T, float>)
    return FieldType::float32;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return FieldType::int64;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return FieldType::uint64;
  else {
    static_assert(std::is_same_v<T, std::uint32_t>, "a field holds double, float, int64, uint64 or uint32");
    return FieldType::uint32;
  }
}

constexpr std::size_t size_of(FieldType type) {
  return type == FieldType::float32 || type == FieldType::uint32 ? 4 : 8;
}

/// One named array of rows × components numbers, row-major and contiguous, or a scalar (scalar = true, one number).
struct Field {
  std::string name;
  FieldType type = FieldType::float64;
  std::size_t components = 1;
  bool scalar = false;
  bool divided = false;                    ///< the rows are distributed over the ranks
  std::string unit;                        ///< "m", "kg", "rad", "1", ...
  std::string about;                       ///< meaning, one line
  std::function<std::size_t()> rows;       ///< current number of rows
  std::function<void(std::size_t)> resize; ///< sets the number of rows before a read; no effect on scalars
  std::function<void*()> data;             ///< the first number; valid until the next resize
  std::size_t bytes() const { return rows() * components * size_of(type); }
};

/// A list of fields that refer to live data. Precondition: the data outlives the table.
class FieldTable {
public:
  /// Adds a scalar. Precondition: no field has this name, here and below.
  template<class T> void scalar(std::string name, T& value, std::string unit, std::string about) {
    Field field = make<T>(std::move(name), 1, std::move(unit), std::move(about));
    field.scalar = true;
    field.rows = [] { return std::size_t{1}; };
    field.resize = [](std::size_t) {};
    field.data = [&value]() -> void* { return &value; };
    fields_.push_back(std::move(field));
  }

  /// Adds a vector. Precondition: each element consists of sizeof(Row) / sizeof(T) numbers of type T.
  template<class T, class Row>
  void rows(std::string name, std::vector<Row>& data, std::string unit, std::string about) {
    static_assert(std::is_standard_layout_v<Row> && sizeof(Row) % sizeof(T) == 0);
    Field field = make<T>(std::move(name), sizeof(Row) / sizeof(T), std::move(unit), std::move(about));
    field.rows = [&data] { return data.size(); };
    field.resize = [&data](std::size_t count) { data.resize(count); };
    field.data = [&data]() -> void* { return data.data(); };
    fields_.push_back(std::move(field));
  }

  /// Adds a vector with one row per particle of this rank.
  template<class T, class Row>
  void particle_rows(std::string name, std::vector<Row>& data, std::string unit, std::string about) {
    rows<T>(std::move(name), data, std::move(unit), std::move(about));
    fields_.back().divided = true;
  }

  const std::vector<Field>& fields() const { return fields_; }

  /// Returns the field with this name, or null.
  const Field* find(const std::string& name) const {
    for (const Field& field : fields_)
      if (field.name == name)
        return &field;
    return nullptr;
  }

private:
  template<class T> static Field make(std::string name, std::size_t components, std::string unit, std::string about) {
    Field field;
    field.name = std::move(name);
    field.type = field_type<T>();
    field.components = components;
    field.unit = std::move(unit);
    field.about = std::move(about);
    return field;
  }

  std::vector<Field> fields_;
};

} // namespace keeler
