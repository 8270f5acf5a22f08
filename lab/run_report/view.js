// The particles of the snapshots that the page holds, on the stage.
"use strict";
(function () {
  const element = (id) => document.getElementById(id);
  if (!element("view-data"))
    return;
  const data = JSON.parse(element("view-data").textContent);

  function bytes(digits) {
    const text = atob(digits);
    const all = new Uint8Array(text.length);
    for (let k = 0; k < text.length; ++k)
      all[k] = text.charCodeAt(k);
    return all;
  }

  const n = data.count;
  const colours = bytes(data.colours);
  const radii = new Float32Array(bytes(data.radii).buffer);
  const largest = radii.reduce((a, b) => Math.max(a, b), 0);
  const stage = makeStage(element("stage"), colours);
  if (!stage)
    return;
  stage.setBox(data.box_m);

  // Returns x, y, z and radius of each particle in 16 bits, and the heights in units.
  function placesOf(snapshot) {
    const units = new Uint16Array(bytes(snapshot.places).buffer), places = new Uint16Array(4 * n);
    for (let k = 0; k < n; ++k) {
      for (let axis = 0; axis < 3; ++axis)
        places[4 * k + axis] = units[axis * n + k];
      places[4 * k + 3] = Math.round(65535 * radii[k] / largest);
    }
    return { places: places, heights: units.subarray(2 * n) };
  }

  // Returns the tones of heights. The colour bar spans their 1st to 99th percentile.
  function tonesOf(heights) {
    const sorted = Uint16Array.from(heights).sort();
    const low = sorted[Math.floor(0.01 * (n - 1))], high = sorted[Math.ceil(0.99 * (n - 1))];
    const scale = high > low ? 255 / (high - low) : 0;
    const metres = (units) => data.low_m[2] + data.unit_m[2] * units;
    return {
      range: { low: metres(low), high: metres(high) },
      bytes: Uint8Array.from(heights, (z) => Math.min(255, Math.max(0, scale * (z - low)))),
    };
  }

  const time = element("time"), choice = element("field");
  function show() {
    const moment = Number(time.value), snapshot = data.snapshots[moment], field = data.fields[Number(choice.value)];
    const { places, heights } = placesOf(snapshot);
    const shown = field
      ? { range: field.range, bytes: bytes(field.bytes[Math.min(moment, field.bytes.length - 1)]) }
      : tonesOf(heights);
    stage.setParticles({
      places: places, tones: shown.bytes, low: data.low_m, unit: data.unit_m.concat([largest / 65535]),
    });
    element("low").textContent = Number(shown.range.low).toPrecision(3);
    element("high").textContent = Number(shown.range.high).toPrecision(3);
    element("quantity").textContent = field ? field.label : data.height_label;
    element("moment").textContent = `orbit ${snapshot.time_orbits.toFixed(2)} (${snapshot.file})`;
    stage.draw();
  }

  let playing = 0;
  element("play").addEventListener("click", () => {
    if (playing) {
      clearInterval(playing);
      playing = 0;
    } else {
      playing = setInterval(() => {
        time.value = String((Number(time.value) + 1) % data.snapshots.length);
        show();
      }, 400);
    }
    element("play").textContent = playing ? "Pause" : "Play";
  });
  time.addEventListener("input", show);
  choice.addEventListener("change", show);
  document.querySelectorAll("[data-look]").forEach((button) =>
    button.addEventListener("click", () => stage.look(button.dataset.look)));

  ["height"].concat(data.fields.map((field) => field.name)).forEach((name, k) => choice.add(new Option(name, String(k - 1))));
  time.max = String(data.snapshots.length - 1);
  time.value = time.max;
  paintBar(element("bar"), colours);
  element("shown").textContent = (n < data.of ? `${n} of ${data.of} particles` : `All ${n} particles`) + stageHelp;
  stage.fit();
  show();
  stage.look("oblique");
})();
