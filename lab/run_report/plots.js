// A run's series, drawn by dygraphs. All plots share the zoom of the time axis.
"use strict";

// Returns what draws data of plots into an element, again when they have grown.
function makePlots(parent) {
  const colours = ["#2166ac", "#b2182b", "#1b7837", "#762a83"];
  let data = null, graphs = [], drawn = "", chosen = null;

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

  // --- a plot of any quantity over any other

  // Returns what may be an axis: the time, which has no points, the curves, and the numbers of single snapshots.
  function quantities() {
    const named = (name, unit, points) => ({ name: unit ? `${name}, ${unit}` : name, points: points });
    return [named("time", "orbits", null)].concat(
      data.plots.flatMap((plot) => plot.curves.map((curve) => named(`${plot.title}: ${curve.name}`, plot.unit, curve.points))),
      data.snapshots.map((one) => named(`snapshots: ${one.title}`, one.unit, one.curves[0].points)));
  }

  // Returns the value between two points, null before the first and after the last one.
  function valueAt(points, time) {
    const k = points.findIndex(([t]) => t >= time);
    if (k < 0 || (k === 0 && points[0][0] > time))
      return null;
    const [t, value] = points[k], [before, from] = points[Math.max(k - 1, 0)];
    return t > before ? from + (value - from) * (time - before) / (t - before) : value;
  }

  // Returns [x, y] at the times of the quantity with fewer points, the other one interpolated.
  function pairs(x, y) {
    const times = (!x || (y && y.length <= x.length) ? y || [] : x).map(([time]) => time);
    const at = (points, time) => points ? valueAt(points, time) : time;
    return times.map((time) => [at(x, time), at(y, time)])
      .filter(([a, b]) => a !== null && b !== null).sort((a, b) => a[0] - b[0]);
  }

  function select(above, text, name) {
    const label = part(above, "label", "");
    label.textContent = text + " ";
    const choice = part(label, "select", name);
    quantities().forEach((one, k) => choice.add(new Option(one.name, String(k))));
    choice.addEventListener("change", drawChosen);
    return choice;
  }

  function chooser() {
    const all = part(parent, "div", "plot chosen");
    part(all, "h3", "").textContent = "Any quantity over any other";
    const controls = part(all, "div", "controls");
    const made = { y: select(controls, "Up", "up"), x: select(controls, "Right", "right"), graph: null };
    made.y.value = "1";
    made.box = part(all, "div", "any");
    return made;
  }

  function drawChosen() {
    const [x, y] = [chosen.x, chosen.y].map((choice) => quantities()[Number(choice.value)]);
    const table = pairs(x.points, y.points);
    if (chosen.graph)
      chosen.graph.destroy();
    chosen.graph = null;
    chosen.box.textContent = table.length ? "" : "These two have no time in common.";
    if (table.length)
      chosen.graph = new Dygraph(chosen.box, table, {
        labels: [x.name, y.name], xlabel: x.name, colors: colours, legend: "never", drawPoints: true, pointSize: 2.5,
        strokeWidth: x.points ? 0 : 1.5, axisLabelFontSize: 12, xLabelHeight: 16,
        axes: { x: { axisLabelFormatter: plain }, y: { axisLabelFormatter: plain, axisLabelWidth: 76 } },
      });
  }

  return function show(next) {
    data = next;
    const curves = JSON.stringify(data.plots.map((plot) => [plot.title, plot.curves.map((curve) => curve.name)]));
    if (curves === drawn) {
      graphs.forEach((graph, k) => graph.updateOptions({ file: rows(data.plots[k].curves) }));
      if (chosen)
        drawChosen();
      return;
    }
    drawn = curves;
    graphs.forEach((graph) => graph.destroy());
    parent.textContent = "";
    const boxes = data.plots.map(box);
    chosen = data.plots.length ? chooser() : null;
    graphs = boxes.map(draw);
    if (chosen)
      drawChosen();
  };
}

if (document.getElementById("series-data"))
  makePlots(document.getElementById("plots"))(JSON.parse(document.getElementById("series-data").textContent));
