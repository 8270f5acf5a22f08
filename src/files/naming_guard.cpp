#include <keeler/files/naming_guard.hpp>

#include <utility>

namespace keeler {
namespace {

thread_local const NamingGuard* innermost = nullptr;

} // namespace

NamingGuard::NamingGuard(std::function<void()> check)
    : check_(std::move(check)), outer_(std::exchange(innermost, this)) {}

NamingGuard::~NamingGuard() {
  innermost = outer_;
}

void NamingGuard::ask() {
  if (innermost)
    innermost->check_();
}

} // namespace keeler
