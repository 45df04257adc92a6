// What the fuzzers ask of AddressSanitizer, for speed; ASAN_OPTIONS overrules it.
//
// Four frames of each allocation instead of thirty: a finding is run again by itself for the rest,
// with ASAN_OPTIONS=malloc_context_size=30. Freed memory stays poisoned until 16 MiB more are
// freed, instead of 256: many inputs' worth, and what is larger is unmapped, so that its use is
// found, too. Pages are not given back to the system, which would have to clear them again.
extern "C" const char* __asan_default_options();

const char* __asan_default_options() {
  return "malloc_context_size=4:quarantine_size_mb=16:allocator_release_to_os_interval_ms=-1";
}
