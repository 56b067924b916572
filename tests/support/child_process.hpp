#pragma once  // SPDX-License-Identifier: MIT

#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/descriptor.hpp"

namespace support {

/// The system calls that start and signal a child. Tests replace them.
struct ProcessCalls {
  pid_t (*fork)() = ::fork;
  int (*kill)(pid_t, int) = ::kill;
};

/// The processes besides the child that receive its signals.
enum class Session {
  kShared,    ///< None.
  kOwnGroup,  ///< Processes that it starts.
  kTerminal,  ///< Processes that it starts. Its input becomes its controlling terminal.
};

struct ChildSetup {
  std::vector<std::string> arguments{};  ///< The program, searched for in PATH; then its arguments.
  std::vector<std::string> variables{};  ///< Added to the environment, NAME=value each.
  std::string folder{};                  ///< Working directory; empty: the parent's.
  int input = -1;                        ///< -1: /dev/null.
  int output = -1;                       ///< -1: inherited.
  int error = -1;                        ///< -1: inherited.
  Session session = Session::kShared;
};

/// A child process for the lifetime of this object. The tests fork and send signals nowhere else.
///
/// A failed start fails the test with the program and the reason; the object then has no process
/// and signals nobody. The kernel also ends the child when the thread that started it dies, so
/// killed tests leave no process behind.
class ChildProcess {
 public:
  explicit ChildProcess(const ChildSetup& setup, const ProcessCalls& calls = {})
      : calls_(calls), signals_group_(setup.session != Session::kShared) {
    const int error = start(setup);
    if (error == 0) return;
    ADD_FAILURE() << "cannot start " << setup.arguments.front() << ": " << text_of_errno(error);
  }
  ~ChildProcess() {
    signal(SIGKILL);
    wait();
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Process id; 0 if it was not started.
  [[nodiscard]] pid_t id() const { return process_; }
  /// Sends a signal to the child, or to its group. Does nothing once it has been waited for.
  /// Numbers below 2 are never signalled: kill() takes -1 and 0 for many processes, and 1 is init.
  void signal(int number) const {
    if (is_over_ || process_ < 2) return;
    calls_.kill(signals_group_ ? -process_ : process_, number);
  }
  /// Waits without a limit. @return the exit status; -1 if a signal ended it or it never started.
  int wait() {
    poll(0);
    return exit_status();
  }
  /// @return Whether it ends within this time.
  [[nodiscard]] bool ends_within(std::chrono::seconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    while (!poll(WNOHANG) && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return is_over_;
  }
  [[nodiscard]] bool is_over() { return poll(WNOHANG); }
  /// After the end: the exit status; -1 if a signal ended it or it never started.
  [[nodiscard]] int exit_status() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }
  /// After the end: the signal that ended it, or 0.
  [[nodiscard]] int ended_by() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }

 private:
  static constexpr int kNoStatus = 0x7f;  // neither exited nor signaled

  // @return Whether it has ended.
  bool poll(int flags) {
    if (is_over_) return true;
    pid_t ended = 0;
    do {
      ended = waitpid(process_, &status_, flags);
    } while (ended < 0 && errno == EINTR);
    is_over_ = ended != 0;
    if (ended < 0) status_ = kNoStatus;
    return is_over_;
  }

  // All allocation happens before the fork. @return 0, or the errno.
  int start(const ChildSetup& setup) {
    const std::vector<char*> argv = pointers_to(setup.arguments);
    const std::vector<std::string> variables = environment_with(setup.variables);
    const std::vector<char*> environment = pointers_to(variables);
    const Descriptor nothing("/dev/null", O_RDONLY);
    Pipe failure;
    const pid_t process = calls_.fork();
    if (process == 0) {
      const int input = setup.input >= 0 ? setup.input : nothing.number();
      become(setup, input, argv.data(), environment.data(), failure.in.number());
    }
    if (process < 0) return errno;
    process_ = process;
    is_over_ = false;
    if (setup.session == Session::kOwnGroup) setpgid(process, process);  // before it is signalled
    failure.in.close();
    int error = 0;
    const std::string report = failure.out.read_some();  // ends when the program starts
    if (report.size() != sizeof error) return 0;
    report.copy(reinterpret_cast<char*>(&error), sizeof error);
    wait();
    process_ = 0;
    status_ = kNoStatus;
    return error;
  }

  // Runs in the child. Only system calls: other threads may have held locks at the fork.
  [[noreturn]] static void become(const ChildSetup& setup,
                                  int input,
                                  char* const* argv,
                                  char* const* environment,
                                  int failure) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::signal(SIGHUP, SIG_DFL);  // nohup would have it ignored
    if (setup.session == Session::kOwnGroup) setpgid(0, 0);
    if (setup.session == Session::kTerminal) {
      setsid();
      ioctl(input, TIOCSCTTY, 0);
    }
    dup2(input, STDIN_FILENO);
    if (setup.output >= 0) dup2(setup.output, STDOUT_FILENO);
    if (setup.error >= 0) dup2(setup.error, STDERR_FILENO);
    close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
    if (setup.folder.empty() || chdir(setup.folder.c_str()) == 0) {
      execvpe(argv[0], argv, environment);
    }
    const int error = errno;
    (void)!write(failure, &error, sizeof error);
    _exit(127);
  }

  static std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (const std::string& each : texts) pointers.push_back(const_cast<char*>(each.c_str()));
    pointers.push_back(nullptr);
    return pointers;
  }
  // An added variable replaces one of the same name.
  static std::vector<std::string> environment_with(const std::vector<std::string>& added) {
    std::vector<std::string> all = added;
    for (char** each = environ; *each != nullptr; ++each) {
      const std::string one = *each;
      const std::string name = one.substr(0, one.find('=') + 1);
      const bool is_added = std::any_of(
          added.begin(), added.end(), [&](const std::string& a) { return a.starts_with(name); });
      if (!is_added) all.push_back(one);
    }
    return all;
  }

  const ProcessCalls calls_;
  const bool signals_group_;
  pid_t process_ = 0;
  bool is_over_ = true;  // nothing is left to signal or to wait for
  int status_ = kNoStatus;
};

/// Exit status and standard output of a shell command line.
struct Outcome {
  int status = -1;  ///< -1 if a signal ended it or it could not be started.
  std::string text;
};

/// Runs a shell command line to its end.
inline Outcome run_shell(const std::string& command) {
  Outcome outcome;
  Pipe pipe;
  ChildProcess shell({.arguments = {"sh", "-c", command}, .output = pipe.in.number()});
  pipe.in.close();
  for (std::string part; !(part = pipe.out.read_some()).empty();) outcome.text += part;
  outcome.status = shell.wait();
  return outcome;
}

}  // namespace support
