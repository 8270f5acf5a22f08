// What `keeler analyze` prints of the transport of angular momentum as text.
#pragma once

#include <keeler/runs/transport_report.hpp>

namespace keeler {

void print_transport(const TransportReport& report, const Patch& patch);

} // namespace keeler
