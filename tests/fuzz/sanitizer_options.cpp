// The options of AddressSanitizer for fuzzers, for speed; ASAN_OPTIONS overrides them.
//
// Four frames of each allocation instead of thirty: rerun a finding alone with
// ASAN_OPTIONS=malloc_context_size=30 for all frames. Pages are not returned to the system, which
// would have to clear them again. The quarantine of freed memory is 8 MiB, more than most inputs
// free, so that reused memory is still in the processor's cache.
extern "C" const char* __asan_default_options();

const char* __asan_default_options() {
  return "malloc_context_size=4:allocator_release_to_os_interval_ms=-1:quarantine_size_mb=8:"
         "thread_local_quarantine_size_kb=256";
}
