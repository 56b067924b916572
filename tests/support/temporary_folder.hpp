#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace support {

/// A folder of its own, gone at the end: tests that run beside each other do not meet in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    gchar* path = g_dir_make_tmp("gst-ellipse-XXXXXX", nullptr);
    path_ = path;
    g_free(path);
  }
  ~TemporaryFolder() {
    const std::string command = "rm -rf '" + path_ + "'";
    if (std::system(command.c_str()) != 0) std::perror("rm");
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace support
