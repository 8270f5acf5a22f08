// MP4 by a child process: ffmpeg receives the pixels of the pages through a pipe. The file gets its name when it is
// finished; a failure before that leaves no file.
#pragma once

#include <keeler/files/new_file.hpp>
#include <keeler/plot/page.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include <sys/types.h>

namespace keeler::render {

class Mp4 {
public:
  Mp4(const std::filesystem::path& file, int width, int height);
  Mp4(const Mp4&) = delete;
  Mp4& operator=(const Mp4&) = delete;
  ~Mp4();

  /// Appends a frame; all frames must have one size. Throws IoError.
  void add(plot::Page& page);
  /// Completes the file. Throws IoError.
  void finish();

private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  bool ended_well();
  std::string first_message() const;
  [[noreturn]] void fail() const;

  std::filesystem::path name_;
  files::NewFile file_;
  std::unique_ptr<std::FILE, CloseFile> messages_; // standard error of ffmpeg, an unnamed file
  int pipe_ = -1;
  pid_t process_ = -1; // -1: it has ended
};

} // namespace keeler::render
