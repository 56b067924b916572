// SPDX-License-Identifier: MIT
#include "core/text_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace ellipse {
namespace {

class TextFile : public testing::Test {
 protected:
  ~TextFile() override { std::filesystem::remove(path_); }

  void write(const std::string& text) { std::ofstream(path_, std::ios::binary) << text; }

  // The message behind the path.
  static std::string refusal(const std::string& path) {
    try {
      (void)read_text_file(path);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what()).substr(path.size());
    }
    return "";
  }

  std::string path_ = testing::TempDir() + "text_file_test.txt";
};

TEST_F(TextFile, IsReadWithoutItsByteOrderMark) {
  write(
      "\xEF\xBB\xBF"
      "a 1\r\n");
  EXPECT_EQ(read_text_file(path_), "a 1\r\n");
}

TEST_F(TextFile, IsRejectedWithItsPathAndReason) {
  EXPECT_EQ(refusal(path_), ": cannot be read");
  EXPECT_EQ(refusal(testing::TempDir()), ": is not a regular file");
  write(" \n\t");
  EXPECT_EQ(refusal(path_), ": is empty");
  write(std::string("a\0b", 3));
  EXPECT_EQ(refusal(path_), ": is not a text file");
  write(std::string(kMaxTextFile, 'a'));
  EXPECT_EQ(refusal(path_), "");
  write(std::string(kMaxTextFile + 1, 'a'));
  EXPECT_EQ(refusal(path_), ": is larger than 1 MB");
}

}  // namespace
}  // namespace ellipse
