#include "numbers.hpp"

namespace keeler::python {

using Json = nlohmann::ordered_json;

py::object as_python(const Json& json) {
  switch (json.type()) {
  case Json::value_t::object: {
    py::dict object;
    for (const auto& [name, value] : json.items())
      object[py::str(name)] = as_python(value);
    return object;
  }
  case Json::value_t::array: {
    py::list list;
    for (const Json& value : json)
      list.append(as_python(value));
    return list;
  }
  case Json::value_t::boolean:
    return py::bool_(json.get<bool>());
  case Json::value_t::number_integer:
    return py::int_(json.get<std::int64_t>());
  case Json::value_t::number_unsigned:
    return py::int_(json.get<std::uint64_t>());
  case Json::value_t::number_float:
    return py::float_(json.get<double>());
  case Json::value_t::string:
    return py::str(json.get<std::string>());
  default:
    return py::none();
  }
}

py::dict described(std::span<const quantities::Quantity> quantities) {
  py::dict all;
  for (const quantities::Quantity& quantity : quantities)
    for (const quantities::UnitSystem system : quantity.systems()) {
      const bool has_spread = quantity.spread != quantities::Spread::none;
      all[py::str(quantity.full_name(system))] = py::make_tuple(
          std::string(unit_in(quantity.unit, system).text), quantity.meaning,
          has_spread ? py::object(py::str(quantity.spread_name())) : py::object(py::none()), quantity.full_name());
    }
  return all;
}

} // namespace keeler::python
