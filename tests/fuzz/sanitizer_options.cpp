// What the fuzzers ask of AddressSanitizer, for speed; ASAN_OPTIONS overrules it.
//
// Four frames of each allocation instead of thirty: a finding is run again by itself for the rest,
// with ASAN_OPTIONS=malloc_context_size=30. Pages are not given back to the system, which would
// have to clear them again. Freed memory is kept from use for 8 MiB of frees, more than most inputs
// make, so that it is still in the processor's cache when it is used again.
extern "C" const char* __asan_default_options();

const char* __asan_default_options() {
  return "malloc_context_size=4:allocator_release_to_os_interval_ms=-1:quarantine_size_mb=8:"
         "thread_local_quarantine_size_kb=256";
}
