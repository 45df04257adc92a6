#include "streaming/file/mapped_file.h"

#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <exception>
#include <functional>
#include <string>
#include <utility>

namespace svdag {

struct MappedFile::Mapping {
  Mapping(File whole, size_t size, const FileState& before);
  Mapping(const Mapping&) = delete;
  ~Mapping();

  bool holds(const void* address) const {
    return std::less_equal<>()(data, address) &&
           std::less<>()(address, static_cast<const char*>(data) + size);
  }

  // False if a file server cannot be reached now: the content read so far is valid.
  bool changed() const noexcept {
    try {
      return state_of(file) != state;
    } catch (const std::exception&) {
      return false;
    }
  }

  File file;
  FileState state;
  void* data;
  size_t size;
  // Messages of the signal handler, which must not allocate.
  std::string lost;
  std::unique_ptr<const std::string> written;
};

namespace {

// Mappings that the signal handler can read without locking or allocating. More files can be
// mapped, but a lost page of those ends the program without a message.
std::array<std::atomic<const MappedFile::Mapping*>, 16> mappings;
static_assert(std::atomic<const MappedFile::Mapping*>::is_always_lock_free);
std::atomic_flag reported;
// Message about one file that had changed when it was unmapped; never freed.
std::atomic<const std::string*> changed_before{nullptr};
const char* program_name = "";
struct sigaction previous_bus, previous_segv;

void print(const char* text) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
}

[[noreturn]] void exit_with(const std::string& sentence) {
  while (reported.test_and_set()) ::pause();  // another thread has reported and ends the process
  print(program_name);
  print(": ");
  print(sentence.c_str());
  print("\n");
  ::_exit(int(ExitCode::kBadInput));
}

extern "C" void report_lost_page(int number, siginfo_t* info, void*) {
  const bool sent = info->si_code <= 0;  // by a process, not by a memory access
  for (const auto& each : mappings) {
    const MappedFile::Mapping* mapping = each.load();
    if (sent || mapping == nullptr) continue;
    if (number == SIGBUS && mapping->holds(info->si_addr)) exit_with(mapping->lost);
    if (number == SIGSEGV && mapping->changed()) exit_with(*mapping->written);
  }
  // The access is repeated after the return and then reaches the previous handler.
  ::sigaction(number, number == SIGBUS ? &previous_bus : &previous_segv, nullptr);
  if (sent) ::raise(number);
}

constexpr const char* kLost = "can no longer be read: it was cut short, or its disk failed";

std::string message_about(const File& file, const char* sentence) {
  return Error(ExitCode::kBadInput, sentence, file.path()).what();
}

}  // namespace

MappedFile::Mapping::Mapping(File whole, size_t bytes, const FileState& before)
    : file(std::move(whole)),
      state(before),
      data(::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file.descriptor(), 0)),
      size(bytes),
      lost(message_about(file, kLost)),
      written(std::make_unique<const std::string>(message_about(file, kChangedInput))) {
  if (data == MAP_FAILED) fail_input(file.path(), "cannot be mapped into memory");
  for (auto& each : mappings) {
    const Mapping* none = nullptr;
    if (each.compare_exchange_strong(none, this)) break;
  }
}

MappedFile::Mapping::~Mapping() {
  if (changed()) {
    const std::string* none = nullptr;
    if (changed_before.compare_exchange_strong(none, written.get())) (void)written.release();
  }
  for (auto& each : mappings) {
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
  for (const auto& each : mappings) {
    const MappedFile::Mapping* mapping = each.load();
    if (mapping != nullptr && mapping->changed()) fail_input(mapping->file.path(), kChangedInput);
  }
}

const std::string* changed_mapped_file() noexcept {
  for (const auto& each : mappings) {
    const MappedFile::Mapping* mapping = each.load();
    if (mapping != nullptr && mapping->changed()) return mapping->written.get();
  }
  return changed_before;
}

void install_lost_page_handlers(const char* program) {
  program_name = program;
  struct sigaction action = {};
  action.sa_sigaction = report_lost_page;
  action.sa_flags = SA_SIGINFO;
  sigemptyset(&action.sa_mask);
  ::sigaction(SIGBUS, &action, &previous_bus);
  ::sigaction(SIGSEGV, &action, &previous_segv);
}

}  // namespace svdag
