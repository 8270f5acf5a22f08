#include "job_list.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/json_of_files.hpp>
#include <keeler/core/stopwatch.hpp>
#include <keeler/files/descriptor.hpp>
#include <keeler/files/files.hpp>

#include <fmt/format.h>

#include <cassert>
#include <span>
#include <sstream>

#include <fcntl.h>

namespace keeler::study {

JobList::JobList(const std::filesystem::path& file) : file_(file) {
  if (!std::filesystem::exists(file))
    return;
  std::istringstream lines(files::read_lines(file));
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const Json entry = json_of<Json>(line);
    if (!entry.is_object() || !entry.contains("job") || !entry["job"].is_string() || !entry.contains("result"))
      continue;
    results_[entry["job"].get<std::string>()] = entry["result"];
    text += line + "\n";
  }
  if (text.size() != std::filesystem::file_size(file))
    files::write_text(file, text); // drops the incomplete line of an interrupted program
}

void JobList::keep(const std::string& name, const Json& result) {
  const std::string line = json_text(Json{{"job", name}, {"result", result}}) + "\n";
  files::Descriptor out(file_, O_WRONLY | O_CREAT | O_APPEND | O_NOFOLLOW);
  try {
    out.append_whole(std::as_bytes(std::span(line)));
  } catch (const IoError& error) {
    throw IoError(fmt::format("{}; free some space and start the same command again", error.what()));
  }
  results_[name] = result;
}

bool JobList::run(const std::vector<Job>& jobs, const std::function<void(const Progress&)>& progress,
                  const std::atomic<bool>& stop) {
  double elapsed = 0.0, spent = 0.0, all = 0.0, done = 0.0;
  for (const Job& job : jobs) {
    assert(job.weight >= 0.0 && job.work);
    all += job.weight;
  }
  for (const Job& job : jobs) {
    if (stop)
      return false;
    if (!results_.contains(job.name)) {
      {
        const Stopwatch watch(elapsed);
        keep(job.name, job.work());
      }
      spent += job.weight;
    }
    done += job.weight;
    const double left = spent > 0.0 ? elapsed * (all - done) / spent : 0.0;
    progress({done / all, elapsed, left, job.name});
  }
  return true;
}

} // namespace keeler::study
