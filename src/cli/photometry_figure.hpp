// The figure of keeler photometry: I/F against ring longitude and, where there are several, against the phase angle.
#pragma once

#include <keeler/light/photometry.hpp>
#include <keeler/plot/figure.hpp>

#include <filesystem>
#include <span>
#include <string>

namespace keeler::cli {

class PhotometryFigureFile {
public:
  /// Throws UsageError for a name without the ending of a figure, or of a file that is no figure.
  explicit PhotometryFigureFile(const std::string& name);

  /// Writes the figure and prints its name.
  void write(std::span<const light::Photometry> found) const;

private:
  std::filesystem::path file_;
  plot::PageFormat format_;
};

} // namespace keeler::cli
