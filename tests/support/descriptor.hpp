#pragma once  // SPDX-License-Identifier: MIT

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

namespace support {

/// The message of an errno.
inline std::string text_of_errno(int error) {
  return std::generic_category().message(error);
}

/// Owns an open file descriptor. Child processes do not inherit it.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  /// Opens a file; fails the test on error.
  Descriptor(const std::string& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (number_ < 0) ADD_FAILURE() << "cannot open " << path << ": " << text_of_errno(errno);
  }
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }
  /// @return The bytes that the next read returns; empty at the end. Blocks until some arrive.
  [[nodiscard]] std::string read_some() const {
    std::array<char, 4096> block;
    ssize_t size = 0;
    do {
      size = ::read(number_, block.data(), block.size());
    } while (size < 0 && errno == EINTR);
    return size > 0 ? std::string(block.data(), static_cast<std::size_t>(size)) : std::string();
  }

 private:
  int number_;
};

/// Bytes written to `in` are read from `out`.
class Pipe {
 public:
  Pipe() : Pipe(open()) {}

 private:
  explicit Pipe(const std::array<int, 2>& ends) : out(ends[0]), in(ends[1]) {}
  static std::array<int, 2> open() {
    std::array<int, 2> ends{-1, -1};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) {
      ADD_FAILURE() << "cannot open a pipe: " << text_of_errno(errno);
    }
    return ends;
  }

 public:
  Descriptor out;
  Descriptor in;
};

}  // namespace support
