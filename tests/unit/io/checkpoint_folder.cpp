#include <keeler/io/checkpoint_folder.hpp>

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/io/checkpoint.hpp>

#include <doctest/doctest.h>

namespace checkpoint_folder_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

void write_step(const TemporaryFolder& folder, std::int64_t step) {
  FieldTable table;
  table.scalar("step", step, "1", "steps done");
  write_checkpoint(checkpoint_path(folder.path(), step), table, {});
}

void damage(const std::filesystem::path& file) {
  std::string content = files::read_text(file);
  content[content.size() / 2] ^= 1;
  files::write_text(file, content);
}

} // namespace

TEST_CASE("checkpoints are listed by number, newest first") {
  const TemporaryFolder folder;
  for (const int step : {5, 1000000, 20, 999999})
    write_step(folder, step);
  for (const char* other :
       {"checkpoint_.h5", "checkpoint_12a.h5", "snap_000030.hdf", "checkpoint_000040.h5.keeler-0123456789abcdef.tmp"})
    files::write_text(folder / other, "");
  const auto files = list_checkpoints(folder.path());
  REQUIRE(files.size() == 4);
  CHECK(files[0].filename() == "checkpoint_1000000.h5");
  CHECK(files[1].filename() == "checkpoint_999999.h5");
  CHECK(files[3].filename() == "checkpoint_000005.h5");
}

TEST_CASE("when the newest checkpoint is damaged, the previous one is used with a warning") {
  const TemporaryFolder folder;
  for (const int step : {10, 20, 30})
    write_step(folder, step);
  CHECK(newest_valid_checkpoint(folder.path()).path == checkpoint_path(folder.path(), 30));
  CHECK(newest_valid_checkpoint(folder.path()).warnings.empty());

  damage(checkpoint_path(folder.path(), 30));
  NewestCheckpoint newest = newest_valid_checkpoint(folder.path());
  CHECK(newest.path == checkpoint_path(folder.path(), 20));
  REQUIRE(newest.warnings.size() == 1);
  CHECK(newest.warnings[0].find("checkpoint_000030.h5' is damaged") != std::string::npos);

  files::write_text(checkpoint_path(folder.path(), 20), "");
  newest = newest_valid_checkpoint(folder.path());
  CHECK(newest.path == checkpoint_path(folder.path(), 10));
  CHECK(newest.warnings.size() == 2);

  damage(checkpoint_path(folder.path(), 10));
  CHECK_THROWS_WITH_AS(newest_valid_checkpoint(folder.path()), doctest::Contains("can be used"), IoError);
}

TEST_CASE("a folder without checkpoints is an error") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(newest_valid_checkpoint(folder.path()), doctest::Contains("there is no checkpoint"), IoError);
  CHECK_THROWS_AS(newest_valid_checkpoint(folder / "absent"), IoError);
}

TEST_CASE("pruning keeps the newest and removes torn files") {
  const TemporaryFolder folder;
  for (const int step : {10, 20, 30, 40})
    write_step(folder, step);
  files::write_text(folder / "checkpoint_000050.h5.keeler-0123456789abcdef.tmp", "torn");
  files::write_text(folder / "series.csv", "");
  prune_checkpoints(checkpoint_path(folder.path(), 40));
  const auto files = list_checkpoints(folder.path());
  REQUIRE(files.size() == 2);
  CHECK(files[1] == checkpoint_path(folder.path(), 30));
  CHECK(folder.file_count() == 3);
  prune_checkpoints(checkpoint_path(folder.path(), 40), 3);
  CHECK(folder.file_count() == 3);
}

TEST_CASE("pruning counts from the checkpoint that a run resumes from; later ones are removed separately") {
  const TemporaryFolder folder;
  for (const int step : {10, 20, 30, 40, 50})
    write_step(folder, step);
  const auto newest = checkpoint_path(folder.path(), 30);
  prune_checkpoints(newest);
  CHECK(list_checkpoints(folder.path()).size() == 4);
  remove_later_checkpoints(newest);
  const auto files = list_checkpoints(folder.path());
  REQUIRE(files.size() == 2);
  CHECK(files[0] == newest);
  CHECK(files[1] == checkpoint_path(folder.path(), 20));
}

} // namespace checkpoint_folder_test
