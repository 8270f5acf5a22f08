// Readers and writers of tables of particles, one of each format. Readers get the whole content, and the name of the
// file for messages; read_particle_table() chooses among them.
#pragma once

#include "hdf5.hpp"

#include <keeler/io/particle_table.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace keeler::io {

ParticleTable read_csv_table(std::string_view text, const std::string& file);
void write_csv_table(const std::filesystem::path& file, const ParticleTable& table);

/// One array per column in the root, and nothing else.
ParticleTable read_hdf5_table(const hdf5::Handle& root, const std::string& file);
void write_hdf5_table(const std::filesystem::path& file, const ParticleTable& table);

/// True if the root has groups PartTypeN.
bool has_gadget_groups(const hdf5::Handle& root);
ParticleTable read_gadget_table(const hdf5::Handle& root, const std::string& file);
void write_gadget_table(const std::filesystem::path& file, const ParticleTable& table);

bool is_npz(std::string_view content);
ParticleTable read_npz_table(std::string_view content, const std::string& file);
void write_npz_table(const std::filesystem::path& file, const ParticleTable& table);

bool is_xyz(std::string_view text);
ParticleTable read_xyz_table(std::string_view text, const std::string& file);
void write_xyz_table(const std::filesystem::path& file, const ParticleTable& table);

} // namespace keeler::io
