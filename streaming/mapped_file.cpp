#include "streaming/mapped_file.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <functional>
#include <string>

namespace svdag {

struct MappedFile::Mapping {
  Mapping(File whole, size_t size, const FileState& before);
  Mapping(const Mapping&) = delete;
  ~Mapping();

  bool holds(const void* address) const {
    return std::less_equal<>()(data, address) &&
           std::less<>()(address, static_cast<const char*>(data) + size);
  }

  // A server that cannot tell now has told all that was read.
  bool changed() const noexcept {
    try {
      return state_of(file) != state;
    } catch (const Error&) {
      return false;
    }
  }

  File file;
  FileState state;
  void* data;
  size_t size;
  std::string lost;  // what the handler says; it may not allocate
};

namespace {

// What a handler may look at: no lock, no memory of its own. More files than these at a time are
// mapped, too, and end without a sentence.
std::array<std::atomic<const MappedFile::Mapping*>, 16> known;
static_assert(std::atomic<const MappedFile::Mapping*>::is_always_lock_free);
std::atomic_flag told;
std::atomic<bool> one_was_changed{false};
const char* teller = "";
struct sigaction before;

void say(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

extern "C" void tell_of_lost_page(int number, siginfo_t* info, void*) {
  for (const auto& each : known) {
    const MappedFile::Mapping* mapping = each.load();
    if (info->si_code <= 0 || mapping == nullptr || !mapping->holds(info->si_addr)) continue;
    while (told.test_and_set()) ::pause();  // another thread, which ends the process, has said it
    say(teller);
    say(": ");
    say(mapping->lost.c_str());
    ::_exit(int(ExitCode::kBadInput));
  }
  ::sigaction(number, &before, nullptr);    // the access is tried again, and goes there;
  if (info->si_code <= 0) ::raise(number);  // a signal that somebody sent has no access
}

}  // namespace

constexpr const char* kLost = "can no longer be read: it was cut short, or its disk failed";

MappedFile::Mapping::Mapping(File whole, size_t bytes, const FileState& before)
    : file(std::move(whole)),
      state(before),
      data(::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.descriptor(), 0)),
      size(bytes),
      lost(Error(ExitCode::kBadInput, kLost, file.path()).what() + std::string("\n")) {
  if (data == MAP_FAILED) fail_input(file.path(), "cannot be mapped into memory");
  for (auto& each : known) {
    const Mapping* none = nullptr;
    if (each.compare_exchange_strong(none, this)) break;
  }
}

MappedFile::Mapping::~Mapping() {
  if (changed()) one_was_changed = true;
  for (auto& each : known) {
    const Mapping* self = this;
    each.compare_exchange_strong(self, nullptr);
  }
  ::munmap(data, size);
}

MappedFile::MappedFile(File file, size_t size, const FileState& before)
    : mapping_(std::make_unique<const Mapping>(std::move(file), size, before)) {}

MappedFile::MappedFile(MappedFile&&) noexcept = default;

MappedFile::~MappedFile() = default;

const void* MappedFile::data() const {
  return mapping_->data;
}

const std::string& MappedFile::path() const {
  return mapping_->file.path();
}

void require_mapped_files() {
  for (const auto& each : known) {
    const MappedFile::Mapping* mapping = each.load();
    if (mapping != nullptr && mapping->changed())
      fail_input(mapping->file.path(), "was changed while it was read");
  }
}

void require_files_once_mapped() {
  require_mapped_files();
  if (one_was_changed) throw Error(ExitCode::kBadInput, "a file was changed while it was read");
}

void tell_of_lost_pages(const char* program) {
  teller = program;
  struct sigaction action = {};
  action.sa_sigaction = tell_of_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGBUS, &action, &before);
}

}  // namespace svdag
