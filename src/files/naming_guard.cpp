#include <keeler/files/naming_guard.hpp>

#include <cassert>
#include <utility>

namespace keeler::files {
namespace {

thread_local const NamingGuard* innermost = nullptr;

} // namespace

NamingGuard::NamingGuard(std::function<void()> check)
    : check_(std::move(check)), outer_(std::exchange(innermost, this)) {
  assert(check_);
}

NamingGuard::~NamingGuard() {
  assert(innermost == this); // guards nest
  innermost = outer_;
}

void NamingGuard::run_check() {
  if (innermost)
    innermost->check_();
}

} // namespace keeler::files
