// Particles of all ranks in files, in the hash and on migration, against one process that has all particles: equal
// bytes.
#include "launched.hpp"

#include "field_rows.hpp"
#include "unit/files/disk.hpp"

#include <keeler/core/error.hpp>
#include <keeler/core/random.hpp>
#include <keeler/decomposition/blocks.hpp>
#include <keeler/io/checkpoint.hpp>
#include <keeler/io/snapshot.hpp>
#include <keeler/particles/by_id.hpp>
#include <keeler/particles/order.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

using namespace keeler;
using keeler_test::launched;

namespace {

// Ids without gaps from 0 or from some number on, or with gaps.
enum class Ids { dense, later, sparse };

Particles all_particles(std::size_t count, Ids ids, bool rough) {
  Particles all;
  all.rough = rough;
  for (std::size_t k = 0; k < count; ++k) {
    RandomStream random(7, RandomPurpose::position, k);
    const auto number = [&] { return 200.0 * (random.uniform() - 0.5); };
    const std::uint64_t id = (k * 7919) % count; // not sorted: the prime 7919 divides no count here
    all.ids.push_back(ids == Ids::dense   ? id
                      : ids == Ids::later ? id + 1000000
                                          : id * id * 1234567 + (id + 1 == count ? ~std::uint64_t{0} / 2 : 0));
    all.bodies.push_back({{number(), number(), number(), number(), number(), number()}, 1.0, 2.0 + number()});
    if (rough)
      all.spins.push_back({number(), number(), number()});
  }
  return all;
}

void append(Particles& to, const Particles& from, std::size_t k) {
  to.bodies.push_back(from.bodies[k]);
  to.ids.push_back(from.ids[k]);
  if (from.rough)
    to.spins.push_back(from.spins[k]);
}

// Returns an uneven part; with three ranks or more one part is empty.
Particles part_of(const Particles& all, std::size_t rank) {
  const std::size_t holders = std::max<std::size_t>(1, launched().size() - (launched().size() > 2 ? 1 : 0));
  Particles part;
  part.rough = all.rough;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (std::min(holders - 1, (k * k) % (2 * holders)) == rank)
      append(part, all, k);
  return part;
}

Particles sorted(const Particles& all) {
  Particles in_order;
  in_order.rough = all.rough;
  for (const std::uint32_t k : particles::order_by_id(all.ids))
    append(in_order, all, k);
  return in_order;
}

template<class Row> bool same_bytes(const std::vector<Row>& a, const std::vector<Row>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(static_cast<const void*>(a.data()), b.data(), a.size() * sizeof(Row)) == 0);
}

bool same(const Particles& a, const Particles& b) {
  return same_bytes(a.bodies, b.bodies) && same_bytes(a.ids, b.ids) && same_bytes(a.spins, b.spins);
}

// A folder that the root makes and all ranks use.
class SharedFolder {
public:
  SharedFolder() {
    if (launched().is_root())
      folder_ = std::make_unique<test::TemporaryFolder>();
    path_ = folder_ ? folder_->path().string() : "";
    launched().broadcast(path_);
  }
  ~SharedFolder() { launched().any(false); } // removes the folder after all ranks arrived
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  std::filesystem::path operator/(const char* name) const { return std::filesystem::path(path_) / name; }

private:
  std::unique_ptr<test::TemporaryFolder> folder_;
  std::string path_;
};

} // namespace

TEST_CASE("particles of all ranks come in the order of their ids, in pieces of one size") {
  for (const Ids ids : {Ids::dense, Ids::later, Ids::sparse})
    for (const std::size_t rows : {1, 64, 999, 1000, 5000}) {
      CAPTURE(rows);
      const Particles all = all_particles(rows == 1 ? 37 : 1999, ids, rows == 64),
                      own = part_of(all, launched().rank());
      Particles found;
      found.rough = all.rough;
      std::size_t last = rows;
      visit_by_id(own, launched(), rows, [&](const Particles& piece) {
        CHECK(last == rows); // all but the last are full
        CHECK(piece.size() > 0);
        last = piece.size();
        for (std::size_t k = 0; k < piece.size(); ++k)
          append(found, piece, k);
      });
      CHECK((launched().is_root() ? same(found, sorted(all)) : found.size() == 0));
    }
}

TEST_CASE("an error of a piece on the root is thrown on all ranks") {
  const Particles own = part_of(all_particles(1000, Ids::dense, false), launched().rank());
  int pieces = 0;
  CHECK_THROWS_AS(visit_by_id(own, launched(), 100,
                              [&](const Particles&) {
                                if (++pieces == 3)
                                  throw DiskFullError("no room");
                              }),
                  Error);
}

TEST_CASE("rows of a field come in the order of the ranks, in pieces of limited size") {
  const Particles all = all_particles(1999, Ids::dense, false);
  Particles own = part_of(all, launched().rank()), whole;
  for (std::size_t rank = 0; rank < launched().size(); ++rank) {
    const Particles part = part_of(all, rank);
    for (std::size_t k = 0; k < part.size(); ++k)
      append(whole, part, k);
  }
  FieldTable table;
  own.list_fields(table);
  for (const std::size_t max_bytes : {std::size_t{1}, std::size_t{5000}, io::FieldRows::max_piece}) {
    const io::FieldRows rows(table.fields()[0], launched(), max_bytes);
    CHECK(rows.count() == all.size());
    std::vector<std::byte> found;
    rows.visit([&](std::size_t first, std::size_t count, std::span<const std::byte> bytes) {
      CHECK(first * sizeof(Body) == (launched().is_root() ? found.size() : first * sizeof(Body)));
      CHECK(count * sizeof(Body) <= std::max(max_bytes, sizeof(Body)));
      found.insert(found.end(), bytes.begin(), bytes.end());
    });
    if (launched().is_root()) {
      REQUIRE(found.size() == whole.size() * sizeof(Body));
      CHECK(std::memcmp(found.data(), whole.bodies.data(), found.size()) == 0);
    }
  }
}

TEST_CASE("a checkpoint that ranks write is that of one process, byte by byte, and each reads a part of it") {
  const SharedFolder folder;
  const io::CheckpointHeader header{"title = \"pieces\"\n", {{"version", "0"}}};
  const Particles all = all_particles(1999, Ids::later, true);
  Particles own = part_of(all, launched().rank()), whole;
  whole.rough = true;
  for (std::size_t rank = 0; rank < launched().size(); ++rank) {
    const Particles part = part_of(all, rank);
    for (std::size_t k = 0; k < part.size(); ++k)
      append(whole, part, k);
  }
  double number = 0.1;
  const auto table_of = [&](Particles& particles) {
    FieldTable table;
    particles.list_fields(table);
    table.scalar("number", number, "1", "the same on all");
    return table;
  };
  write_checkpoint(folder / "distributed.h5", table_of(own), header, launched());
  launched().on_root([&] {
    write_checkpoint(folder / "alone.h5", table_of(whole), header);
    CHECK(files::read_file(folder / "distributed.h5") == files::read_file(folder / "alone.h5"));
  });
  Particles read;
  read.rough = true;
  number = 0.0;
  const io::Checkpoint checkpoint(folder / "distributed.h5", launched());
  CHECK(checkpoint.header().scene == header.scene);
  checkpoint.read(table_of(read));
  CHECK(number == 0.1);
  CHECK(read.size() <= all.size() / launched().size() + 1);
  Particles found;
  found.rough = true;
  found.bodies = launched().gather(read.bodies);
  found.ids = launched().gather(read.ids);
  found.spins = launched().gather(read.spins);
  CHECK((!launched().is_root() || same(found, whole)));
}

TEST_CASE("a snapshot whose particles come from all ranks is that of one process, byte by byte") {
  const SharedFolder folder;
  const io::SnapshotMeta meta{"title = \"pieces\"\n", {{"version", "0"}}};
  const Particles all = all_particles(2 * io::SnapshotFile::piece + 17, Ids::later, true);
  const auto patch_of = [](const Particles& particles) {
    Patch patch = make_patch(particles, {200.0, 200.0, 1.5, 0.0}, 12.0, Frequencies{}, 0.3);
    patch.orbital_frequency = 1.3e-4;
    return patch;
  };
  std::optional<io::SnapshotFile> distributed;
  launched().on_root([&] {
    write_snapshot(folder / "alone.hdf", patch_of(all), meta);
    distributed.emplace(folder / "distributed.hdf", patch_of(Particles()), all.size(), true, meta);
  });
  visit_by_id(part_of(all, launched().rank()), launched(), io::SnapshotFile::piece,
              [&](const Particles& piece) { distributed->add(patch_of(piece)); });
  launched().on_root([&] {
    distributed->finish();
    CHECK(files::read_file(folder / "distributed.hdf") == files::read_file(folder / "alone.hdf"));
  });
}

TEST_CASE("a damaged checkpoint is an error on all ranks") {
  const SharedFolder folder;
  Particles own = part_of(all_particles(100, Ids::dense, false), launched().rank());
  FieldTable table;
  own.list_fields(table);
  io::write_checkpoint(folder / "a.h5", table, {}, launched());
  launched().on_root([&] {
    std::string bytes = files::read_text(folder / "a.h5");
    bytes[bytes.size() / 2] ^= 1;
    files::write_text(folder / "a.h5", bytes);
  });
  CHECK_THROWS_AS(io::Checkpoint(folder / "a.h5", launched()), Error);
}

TEST_CASE("particles on one rank, or distributed at random, are sent to their owners") {
  const Particles all = all_particles(20011, Ids::dense, true);
  for (const bool with_one : {true, false}) {
    Particles own = with_one ? Particles() : part_of(all, launched().rank());
    if (with_one && launched().rank() == launched().size() - 1)
      own = all;
    own.rough = true;
    std::vector<Vec3> rows, none;
    for (const Body& body : own.bodies)
      rows.push_back({body.elements.guiding_x, body.mass, 0.0});
    ShearingBox box{200.0, 200.0, 1.5, 0.0};
    const std::size_t strips = with_one ? (launched().size() + 1) / 2 : launched().size();
    decomposition::Blocks blocks(launched(), box, Frequencies{}, {.strips = strips});
    blocks.distribute({own, {&rows, &none}});
    CHECK(static_cast<double>(own.size()) < 1.1 * static_cast<double>(all.size() / launched().size()));
    CHECK(rows.size() == own.size());
    for (std::size_t k = 0; k < std::min(rows.size(), own.size()); ++k)
      REQUIRE(rows[k] == Vec3(own.bodies[k].elements.guiding_x, own.bodies[k].mass, 0.0));
    Particles found;
    found.rough = true;
    found.bodies = launched().gather(own.bodies);
    found.ids = launched().gather(own.ids);
    found.spins = launched().gather(own.spins);
    CHECK((!launched().is_root() || same(sorted(found), sorted(all))));
  }
}
