#pragma once

#include <string>
#include <vector>

namespace plumb::tool {

/// A point of a plot, with its name beside it.
struct PlotPoint {
  std::string name;
  double x, y;
  int kind;  ///< its colour and shape: 0, 1, 2 ...
};

struct Plot {
  std::string title, x_label, y_label;
  /// Both axes are logarithmic; a y of 0 is drawn on a line of its own at the bottom, which says so.
  std::vector<PlotPoint> points;
  std::vector<std::string> kinds;  ///< what each kind is called in the legend
  bool lines = false;              ///< joins the points of a kind, in their order; their names are left out
};

/// The plot as an <svg> element, drawn by the program gnuplot. Throws plumb::Error where there is none.
std::string plot_svg(const Plot& plot);

}  // namespace plumb::tool
