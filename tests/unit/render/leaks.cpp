// Fontconfig keeps its font cache until the process ends, by design; the leak sanitizer need not report it.
// The name is the sanitizer's. NOLINTBEGIN(readability-identifier-naming)
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}
// NOLINTEND(readability-identifier-naming)
