// A run's series, drawn by dygraphs. All plots share the zoom of the time axis.
"use strict";

// Returns what draws data of plots into an element, again when they have grown.
function makePlots(parent) {
  const colours = ["#2166ac", "#b2182b", "#1b7837", "#762a83"];
  let data = null, graphs = [], drawn = "";

  // Returns one row per time for dygraphs: [low, middle, high] for each curve, null for curves without a point there.
  function rows(curves) {
    const table = new Map();
    curves.forEach((curve, which) => curve.points.forEach(([time, mean, error]) => {
      if (!table.has(time))
        table.set(time, [time].concat(curves.map(() => null)));
      const half = error === null ? 0 : error;
      table.get(time)[which + 1] = [mean - half, mean, mean + half];
    }));
    return Array.from(table.values()).sort((a, b) => a[0] - b[0]);
  }

  function formatEstimate(value, error) {
    if (value === null)
      return "unknown";
    return error === null ? value.toPrecision(4) : `${value.toPrecision(4)} ± ${error.toPrecision(2)}`;
  }

  function means(plot) {
    return plot.curves.filter((curve) => curve.mean)
      .map((curve) => `${curve.name}: ${formatEstimate(curve.mean.value, curve.mean.error)}`).join("; ");
  }

  function shade(pen, area, graph) {
    if (!data.steady)
      return;
    const left = graph.toDomXCoord(data.steady[0]), right = graph.toDomXCoord(data.steady[1]);
    pen.fillStyle = "rgba(70, 90, 120, 0.10)";
    pen.fillRect(left, area.y, right - left, area.h);
  }

  function part(above, tag, name) {
    const made = document.createElement(tag);
    made.className = name;
    above.appendChild(made);
    return made;
  }

  let zooming = false;
  function zoom(from, to) {
    if (zooming)
      return;
    zooming = true;
    graphs.forEach((graph) => graph.updateOptions({ dateWindow: from === null ? null : [from, to] }));
    zooming = false;
  }

  // Makes all boxes before the first chart is drawn, since a chart takes its width from its box.
  function box(plot) {
    const all = part(parent, "div", "plot");
    part(all, "h3", "").textContent = plot.unit ? `${plot.title}, ${plot.unit}` : plot.title;
    const legend = part(all, "div", "legend"), chart = part(all, "div", "chart");
    part(all, "p", "means").textContent = means(plot);
    return { plot: plot, legend: legend, chart: chart };
  }

  const plain = (value) => String(Number(value.toPrecision(6)));

  function draw({ plot, legend, chart }) {
    return new Dygraph(chart, rows(plot.curves), {
      labels: ["orbit"].concat(plot.curves.map((curve) => curve.name)),
      customBars: true,
      connectSeparatedPoints: true,
      colors: colours,
      legend: "always",
      labelsDiv: legend,
      xlabel: "orbits",
      strokeWidth: 1.5,
      axisLabelFontSize: 12,
      xLabelHeight: 16,
      axes: {
        x: { axisLabelFormatter: plain, valueFormatter: plain },
        y: { axisLabelFormatter: plain, valueFormatter: (value) => value.toPrecision(4), axisLabelWidth: 76 },
      },
      underlayCallback: shade,
      zoomCallback: (from, to) => zoom(from, to),
    });
  }

  return function show(next) {
    data = next;
    const curves = JSON.stringify(data.plots.map((plot) => [plot.title, plot.curves.map((curve) => curve.name)]));
    if (curves === drawn) {
      graphs.forEach((graph, k) => graph.updateOptions({ file: rows(data.plots[k].curves) }));
      return;
    }
    drawn = curves;
    graphs.forEach((graph) => graph.destroy());
    parent.textContent = "";
    graphs = data.plots.map(box).map(draw);
  };
}

if (document.getElementById("series-data"))
  makePlots(document.getElementById("plots"))(JSON.parse(document.getElementById("series-data").textContent));
