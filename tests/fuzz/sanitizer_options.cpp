// What the fuzzers ask of AddressSanitizer, for speed; ASAN_OPTIONS overrules it.
//
// Four frames of each allocation instead of thirty: a finding is run again by itself for the rest,
// with ASAN_OPTIONS=malloc_context_size=30. Pages are not given back to the system, which would
// have to clear them again. Nothing of this hides a finding.
extern "C" const char* __asan_default_options();

const char* __asan_default_options() {
  return "malloc_context_size=4:allocator_release_to_os_interval_ms=-1";
}
