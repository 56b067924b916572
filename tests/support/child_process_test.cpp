// SPDX-License-Identifier: MIT
//
// The owner of the tests' child processes. Tests of failed starts replace the system calls,
// including kill(), so that a fault here reaches no other process.
#include "tests/support/child_process.hpp"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/shell_job.hpp"
#include "tests/support/terminal.hpp"

namespace {

using support::ChildProcess;
using support::ProcessCalls;
using support::Session;
using support::ShellJob;
using support::TemporaryFolder;
using support::Terminal;
using support::TerminalCalls;

std::vector<pid_t> signalled;  // recorded by record_signal

int record_signal(pid_t process, int /*number*/) {
  signalled.push_back(process);
  return 0;
}
pid_t fail_to_fork() {
  errno = EAGAIN;
  return -1;
}
constexpr ProcessCalls kNoFork{fail_to_fork, record_signal};

template <int kErrno>
int fail_to_open(int* near, int* far, char*, const termios*, const winsize*) {
  *near = -1;
  *far = -1;
  errno = kErrno;
  return -1;
}

class Children : public testing::Test {
 protected:
  void SetUp() override { signalled.clear(); }
  const TemporaryFolder folder_;
};

constexpr char kForkFails[] = "Resource temporarily unavailable";

TEST_F(Children, AFailedForkFailsTheTestAndSignalsNobody) {
  EXPECT_NONFATAL_FAILURE(
      {
        ChildProcess child({.arguments = {"sleep", "60"}}, kNoFork);
        child.signal(SIGINT);
        EXPECT_EQ(child.id(), 0);
        EXPECT_TRUE(child.is_over());
        EXPECT_EQ(child.wait(), -1);
      },
      "cannot start sleep: Resource temporarily unavailable");
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, AFailedForkOfAShellJobSignalsNobody) {
  EXPECT_NONFATAL_FAILURE(
      {
        ShellJob job("sleep 60", folder_.path(), "job", kNoFork);
        job.interrupt();
        EXPECT_EQ(job.wait_for_end(), -1);
      },
      kForkFails);
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, AFailedForkAtATerminalSignalsNobody) {
  EXPECT_NONFATAL_FAILURE(
      {
        TerminalCalls calls;
        calls.openpty = [](int* near, int* far, char*, const termios*, const winsize*) {
          support::Pipe pipe;  // replaces a terminal, which the machine may not have
          *near = dup(pipe.out.number());
          *far = dup(pipe.in.number());
          return 0;
        };
        calls.process = kNoFork;
        Terminal terminal({"sleep", "60"}, calls);
        EXPECT_FALSE(terminal.is_missing());
        EXPECT_FALSE(terminal.read_until("anything"));
        EXPECT_EQ(terminal.wait_for_end(), -1);
      },
      kForkFails);
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, MissingTerminalSupportIsDetected) {
  for (const auto open : {fail_to_open<ENOENT>, fail_to_open<ENODEV>}) {
    Terminal terminal({"sleep", "60"}, {open, {fork, record_signal}});
    EXPECT_TRUE(terminal.is_missing());
    EXPECT_TRUE(terminal.reason().starts_with("no pseudo terminal: No such")) << terminal.reason();
    terminal.type('\x03');
    EXPECT_FALSE(terminal.read_until("anything"));
    EXPECT_EQ(terminal.wait_for_end(), -1);
  }
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, ATerminalThatCannotBeOpenedFailsTheTest) {
  EXPECT_NONFATAL_FAILURE(
      {
        const Terminal terminal({"sleep", "60"}, {fail_to_open<EMFILE>, {fork, record_signal}});
        EXPECT_FALSE(terminal.is_missing());
      },
      "no pseudo terminal: Too many open files");
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, ErrorNamesMissingPrograms) {
  EXPECT_NONFATAL_FAILURE(
      {
        ChildProcess child({.arguments = {"no-such-program"}}, {fork, record_signal});
        EXPECT_EQ(child.wait(), -1);
      },
      "cannot start no-such-program: No such file or directory");
  EXPECT_NONFATAL_FAILURE(ChildProcess child({.arguments = {"true"}, .folder = "/no/such/folder"}),
                          "cannot start true: No such file or directory");
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, AreKilledWithTheirOwner) {
  pid_t process = 0;
  {
    ChildProcess child({.arguments = {"sleep", "60"}});
    process = child.id();
    ASSERT_GT(process, 1);
    EXPECT_FALSE(child.is_over());
    EXPECT_EQ(kill(process, 0), 0);
  }
  EXPECT_EQ(kill(process, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST_F(Children, AreNotSignalledOnceTheyHaveBeenWaitedFor) {
  {
    ChildProcess child({.arguments = {"true"}}, {fork, record_signal});
    EXPECT_EQ(child.wait(), 0);
    child.signal(SIGINT);
  }
  EXPECT_EQ(signalled, std::vector<pid_t>{});
}

TEST_F(Children, AreSignalledWithTheirGroupWhereTheyHaveOne) {
  for (const Session session : {Session::kShared, Session::kOwnGroup}) {
    ChildProcess child({.arguments = {"sh", "-c", "read line"}, .session = session},
                       {fork, record_signal});
    child.signal(SIGINT);
    const pid_t expected = session == Session::kShared ? child.id() : -child.id();
    EXPECT_EQ(signalled, std::vector<pid_t>{expected});
    EXPECT_EQ(child.wait(), 1);  // at the end of its input
    signalled.clear();
  }
}

TEST_F(Children, ReportHowTheyEnded) {
  ChildProcess status({.arguments = {"sh", "-c", "exit 3"}});
  EXPECT_EQ(status.wait(), 3);
  EXPECT_EQ(status.ended_by(), 0);
  ChildProcess killed({.arguments = {"sleep", "60"}});
  killed.signal(SIGTERM);
  EXPECT_EQ(killed.wait(), -1);
  EXPECT_EQ(killed.ended_by(), SIGTERM);
  EXPECT_EQ(support::run_shell("echo out; kill -TERM $$").status, -1);
}

TEST_F(Children, RunWithTheirVariablesFolderAndStreams) {
  support::Pipe pipe;
  ChildProcess child({.arguments = {"sh", "-c", "pwd; echo \"$LANG $ADDED\"; read line || echo no"},
                      .variables = {"LANG=C", "ADDED=yes"},
                      .folder = "/usr",
                      .output = pipe.in.number()});
  EXPECT_EQ(child.wait(), 0);
  EXPECT_EQ(pipe.out.read_some(), "/usr\nC yes\nno\n");
}

TEST_F(Children, ATerminalPassesKeysAsSignals) {
  Terminal terminal({"sh", "-c", "trap 'echo caught; exit 7' INT; echo ready; sleep 60 & wait"});
  if (terminal.is_missing()) GTEST_SKIP() << terminal.reason();
  ASSERT_TRUE(terminal.read_until("ready"));
  terminal.type('\x03');
  EXPECT_TRUE(terminal.read_until("caught"));
  EXPECT_EQ(terminal.wait_for_end(), 7);
}

}  // namespace
