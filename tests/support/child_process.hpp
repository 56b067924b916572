#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>
#include <sys/prctl.h>

#include <csignal>
#include <string>
#include <vector>

namespace support {

/// Starts a program that the kernel ends together with the thread that calls this: it is not left
/// behind where the tests are killed. What GLib thinks critical in it ends it too.
/// @return null where it cannot be started; the caller's otherwise.
inline GSubprocess* start_child(const std::vector<std::string>& arguments,
                                GSubprocessFlags flags,
                                GError** problem = nullptr) {
  std::vector<const gchar*> argv;
  for (const std::string& each : arguments) argv.push_back(each.c_str());
  argv.push_back(nullptr);
  GSubprocessLauncher* launcher = g_subprocess_launcher_new(flags);
  g_subprocess_launcher_setenv(launcher, "G_DEBUG", "fatal-criticals", TRUE);
  // Between fork and exec: nothing but a system call.
  g_subprocess_launcher_set_child_setup(
      launcher, [](gpointer) { prctl(PR_SET_PDEATHSIG, SIGKILL); }, nullptr, nullptr);
  GSubprocess* process = g_subprocess_launcher_spawnv(launcher, argv.data(), problem);
  g_object_unref(launcher);
  return process;
}

}  // namespace support
