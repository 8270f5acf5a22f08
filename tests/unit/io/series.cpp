#include <keeler/io/series.hpp>

#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>

#include <doctest/doctest.h>

namespace series_test {

using namespace keeler;
using namespace keeler::io;
using namespace keeler::test;

namespace {

const std::vector<std::string> columns{"time_orbits", "energy"};

void append(Series& series, std::int64_t step) {
  series.append(step, std::vector<double>{0.001 * static_cast<double>(step), 1.0 / 3.0});
}

} // namespace

TEST_CASE("rows are in the file at once and read back to the same bits") {
  const TemporaryFolder folder;
  Series series = Series::begin(folder / "series.csv", columns);
  series.append(0, std::vector<double>{0.0, 0.1 + 0.2});
  series.append(10, std::vector<double>{1e-300, -1.0 / 0.0});
  CHECK(files::read_text(folder / "series.csv") ==
        "step,time_orbits,energy\n0,0,0.30000000000000004\n10,1e-300,-inf\n");
}

TEST_CASE("after a restart the series equals that of an uninterrupted run") {
  const TemporaryFolder folder;
  const auto once = folder / "once.csv", twice = folder / "twice.csv";
  Series whole = Series::begin(once, columns);
  for (int step = 0; step <= 100; step += 5)
    append(whole, step);
  {
    Series first = Series::begin(twice, columns);
    for (int step = 0; step <= 70; step += 5)
      append(first, step);
  }
  files::write_text(twice, files::read_text(twice) + "75,0.0"); // the kill came in the middle of a row
  Series second = Series::resume(twice, columns, 50);
  for (int step = 55; step <= 100; step += 5)
    append(second, step);
  CHECK(files::read_text(twice) == files::read_text(once));
}

TEST_CASE("a restart keeps what is before the checkpoint, whatever that is") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  Series series = Series::begin(file, columns);
  append(series, 0);
  append(series, 5);
  const std::string both = files::read_text(file);
  Series::resume(file, columns, 7);
  CHECK(files::read_text(file) == both);
  Series::resume(file, columns, -1);
  CHECK(files::read_text(file) == "step,time_orbits,energy\n");
  std::filesystem::remove(file);
  Series::resume(file, columns, 7);
  CHECK(files::read_text(file) == "step,time_orbits,energy\n");
}

TEST_CASE("a file that is not this series is an error and stays as it is") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  for (const std::string text : {"step,time_orbits\n1,2\n", "step,time_orbits,energy\n1,2,3\nwhat,2,3\n", ""}) {
    files::write_text(file, text);
    CHECK_THROWS_WITH_AS(Series::resume(file, columns, 10), doctest::Contains("series.csv"), IoError);
    CHECK(files::read_text(file) == text);
  }
}

TEST_CASE("a file that is renamed or removed is restored with all its rows; one that lost rows is an error") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  Series series = Series::begin(file, columns);
  append(series, 0);
  append(series, 5);
  const std::string before = files::read_text(file);
  CHECK_FALSE(series.take_restored());
  std::filesystem::remove(file);
  append(series, 10);
  CHECK(series.take_restored());
  CHECK_FALSE(series.take_restored());
  CHECK(files::read_text(file).starts_with(before + "10,"));
  files::write_text(file, "of another hand");
  series.sync();
  CHECK(series.take_restored());
  CHECK(files::read_text(file).starts_with(before + "10,"));
  std::filesystem::resize_file(file, before.size());
  CHECK_THROWS_WITH_AS(append(series, 15), doctest::Contains("changed by another program"), IoError);
  CHECK_THROWS_AS(series.sync(), IoError);
  CHECK(files::read_text(file) == before);
}

TEST_CASE("a continued file tells which rows it misses; a damaged row is an error") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  const auto gaps_in = [&](const std::string& rows, std::int64_t last_step) {
    files::write_text(file, "step,time_orbits,energy\n" + rows);
    std::vector<std::int64_t> ends;
    const Series series = Series::resume(file, columns, last_step, 5);
    for (const SeriesGap& gap : series.gaps())
      ends.insert(ends.end(), {gap.from, gap.to});
    return ends;
  };
  using Ends = std::vector<std::int64_t>;
  CHECK(gaps_in("0,0,1\n5,0,1\n10,0,1\n", 12) == Ends{});
  CHECK(gaps_in("0,0,1\n0,0,1\n5,0,1\n5,0,1\n", 9) == Ends{}); // two bodies
  CHECK(gaps_in("", 3) == Ends{0, 3});
  CHECK(gaps_in("0,0,1\n15,0,1\n", 22) == Ends{5, 14, 20, 22});
  for (const std::string row : {"5,1\n", "5,1,2,3\n", "6,1,2\n", "5,1,2\n0,1,2\n"})
    CHECK_THROWS_WITH_AS(gaps_in("0,0,1\n" + row, 20), doctest::Contains("line "), IoError);
}

TEST_CASE("a full disk is noticed at the row that does not fit, which leaves nothing behind") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  Series series = Series::begin(file, columns);
  append(series, 0);
  const std::string before = files::read_text(file);
  {
    const SmallDisk disk(before.size() + 8);
    CHECK_THROWS_AS(append(series, 5), DiskFullError);
    CHECK(files::read_text(file) == before);
  }
  append(series, 5);
  CHECK(files::read_text(file) == before + "5,0.005,0.3333333333333333\n");
}

TEST_CASE("a series that a tool of Windows saved is read, and goes on as it was") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  const std::string kept = "step,time_orbits,energy\n0,0,0.5\n5,0.005,1\n";
  files::write_text(file, "\xef\xbb\xbfstep,time_orbits,energy\r\n0,0,0.5\r\n5,0.005,1\r\n");
  CHECK(read_series(file).of("energy") == std::vector<double>{0.5, 1.0});
  CHECK(series_names(file) == columns);
  Series series = Series::resume(file, columns, 7, 5);
  CHECK(series.gaps().empty());
  CHECK(files::read_text(file) == kept);
  append(series, 10);
  CHECK(files::read_text(file).starts_with(kept + "10,"));
}

TEST_CASE("a series with decreasing times is damaged") {
  const TemporaryFolder folder;
  const auto file = folder / "series.csv";
  for (const std::string time : {"nan", "inf", "0.05", "-1"}) {
    files::write_text(file, "step,time_orbits,energy\n0,0,1\n100,0.1,nan\n200," + time + ",1\n");
    CHECK_THROWS_WITH_AS(read_series(file), doctest::Contains("line 4 of '"), IoError);
  }
}

} // namespace series_test
