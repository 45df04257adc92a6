#include "verify/view/connections.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <thread>

#include "verify/view/request_head.h"

namespace svdag {
namespace {

// Half of the open files: the others are for connections that are being answered.
size_t max_open_connections() {
  rlimit files;
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0) return 256;
  return size_t(files.rlim_cur / 2);
}

// Bytes that were received; 0 if nothing has arrived; -1 if the client has closed the connection.
ssize_t receive(int socket, char* to, size_t size) {
  const ssize_t received = ::recv(socket, to, size, MSG_DONTWAIT);
  if (received > 0) return received;
  return received < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

bool has_event(const pollfd& polled) {
  return polled.revents != 0;
}

}  // namespace

Socket::~Socket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Connections::Connections(int listener)
    : listener_(listener),
      max_waiting_(std::min(kMaxWaiting, max_open_connections())),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  // A longer queue than the library's: a page may send many requests at once.
  if (wake_.get() < 0 || ::listen(listener_, 1024) != 0 ||
      ::fcntl(listener_, F_SETFL, O_NONBLOCK) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot serve");
}

void Connections::wait(std::chrono::milliseconds timeout, const Ready& ready) {
  std::vector<pollfd> polled = {{listener_, POLLIN, 0}, {wake_.get(), POLLIN, 0}};
  for (const Waiting& connection : waiting_) polled.push_back({connection.socket.get(), POLLIN, 0});
  for (const Socket& connection : held_) polled.push_back({connection.get(), POLLIN, 0});
  if (::poll(polled.data(), polled.size(), int(timeout.count())) < 0) return;  // a signal

  const Clock::time_point now = Clock::now();
  const pollfd* next = polled.data() + 2;
  std::erase_if(waiting_, [&](Waiting& connection) {
    if (has_event(*next++) && !keeps_waiting(&connection, ready)) return true;
    return connection.deadline <= now;
  });
  std::erase_if(held_, [&](const Socket& connection) {
    char ignored[256];
    // Connections that keeps_waiting() has just begun to hold were not polled.
    return next != polled.data() + polled.size() && has_event(*next++) &&
           receive(connection.get(), ignored, sizeof ignored) < 0;
  });
  if (has_event(polled[1])) {
    uint64_t count;
    if (::read(wake_.get(), &count, sizeof count) < 0 && errno != EAGAIN) return;
    std::vector<Socket> returned;
    {
      const std::lock_guard lock(mutex_);
      returned.swap(put_back_);
    }
    for (Socket& connection : returned) add(std::move(connection));
  }
  if (has_event(polled[0])) accept_all();
}

void Connections::put_back(Socket connection) {
  {
    const std::lock_guard lock(mutex_);
    put_back_.push_back(std::move(connection));
  }
  const uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);  // never full
}

void Connections::accept_all() {
  constexpr int kMaxAtOnce = 64;  // then the connections that have data get their turn
  for (int i = 0; i < kMaxAtOnce; ++i) {
    Socket connection(::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC));
    if (connection.get() < 0) {
      const bool is_full = errno == EMFILE || errno == ENFILE;
      if (is_full && !waiting_.empty()) waiting_.erase(waiting_.begin());
      if (is_full) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return;
    }
    const int yes = 1;
    const timeval time{10, 0};
    ::setsockopt(connection.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    ::setsockopt(connection.get(), SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
    add(std::move(connection));
  }
}

void Connections::add(Socket connection) {
  if (waiting_.size() >= max_waiting_) waiting_.erase(waiting_.begin());
  waiting_.push_back({std::move(connection), {}, Clock::now() + kHeadTime});
}

bool Connections::keeps_waiting(Waiting* connection, const Ready& ready) const {
  std::string& received = connection->received;
  char part[4096];
  const ssize_t size = receive(connection->socket.get(), part, sizeof part);
  if (size < 0) return false;
  const size_t begin = received.size() - std::min<size_t>(received.size(), kEndOfHead.size() - 1);
  received.append(part, size_t(size));
  if (received.find(kEndOfHead, begin) == received.npos && received.size() <= kMaxHeadBytes)
    return true;
  ready(std::move(connection->socket), std::move(received));
  return false;
}

}  // namespace svdag
