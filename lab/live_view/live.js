// The live page: asks for the newest frame again and again, one request at a time, and only while the page is seen.
"use strict";
(function () {
  const element = (id) => document.getElementById(id);
  const frameInterval = 50, stateInterval = 500, plotInterval = 2000; // ms
  const colours = Uint8Array.from(JSON.parse(element("colours").textContent));
  const stage = typeof THREE === "undefined" ? null : makeStage(element("stage"), colours);
  const showPlots = typeof Dygraph === "undefined" ? null : makePlots(element("plots"));
  const time = element("time"), choice = element("field"), limit = element("limit");
  const labels = {
    files: "", starting: "Starting", running: "Running", idle: "Waiting for the next call", finished: "Finished",
    stopped: "Stopped",
  };

  let have = 0, placed = false, names = [], state = null, over = false, asked = "";
  let arrivals = [];

  function say(text) {
    element("fault").textContent = text;
  }

  async function get(what) {
    const reply = await fetch(what, { cache: "no-store" });
    if (!reply.ok)
      throw new Error(reply.status === 500 ? await reply.text() : `the server answers ${reply.status}`);
    return reply;
  }

  async function command(what) {
    try {
      const reply = await fetch(what, { method: "POST" });
      if (reply.ok)
        showState(await reply.json());
    } catch (error) {
      say("The run does not answer any more.");
    }
  }

  // --- the head of a frame

  function fillFields(fields) {
    if (choice.dataset.names === fields.join())
      return;
    choice.dataset.names = fields.join();
    const chosen = choice.value || "speed";
    choice.textContent = "";
    fields.forEach((name) => choice.add(new Option(name, name)));
    choice.value = fields.includes(chosen) ? chosen : "height";
  }

  const isOfFiles = (what) => ["files", "finished"].includes(what.stage);

  // The last position of the slider is the present: in files it is the last snapshot.
  function fillTime(next) {
    const live = Number(time.value) === Number(time.max);
    names = next.snapshots;
    const last = isOfFiles(next) ? Math.max(names.length - 1, 0) : names.length;
    if (Number(time.max) !== last) {
      time.max = String(last);
      if (live)
        time.value = time.max;
    }
    time.hidden = last === 0;
  }

  function showState(next) {
    state = next;
    fillFields(next.fields);
    fillTime(next);
    element("stage-name").textContent = next.paused && next.control ? "Paused" : labels[next.stage];
    element("message").textContent = next.message;
    if (!isOfFiles(next))
      element("orbits").textContent = `orbit ${next.orbits.toFixed(4)}`;
    element("control").hidden = !next.control;
    element("pause").textContent = next.paused ? "Resume" : "Pause";
    element("limit-text").textContent = next.limit > 0 ? `${next.limit} steps/s` : "full";
  }

  // --- particles

  function showRate() {
    const now = performance.now();
    arrivals = arrivals.filter((at) => now - at < 2000).concat([now]);
    const span = now - arrivals[0];
    element("rate").textContent = arrivals.length > 2 && !state.paused ? `${(1000 * (arrivals.length - 1) / span).toFixed(0)} frames/s` : "";
  }

  function showFrame(about, buffer, offset, live) {
    if (!stage)
      return;
    const first = stage.setBox(about.box_m);
    stage.setParticles({
      places: new Uint16Array(buffer, offset, 4 * about.count),
      tones: new Uint8Array(buffer, offset + 8 * about.count, about.count),
      low: about.low_m,
      unit: about.unit_m,
    });
    if (first || !placed) {
      stage.fit();
      stage.look("oblique");
      placed = true;
    }
    stage.drawSoon();
    const [low, high] = about.range;
    element("low").textContent = Number(low).toPrecision(3);
    element("high").textContent = Number(high).toPrecision(3);
    element("quantity").textContent = about.label;
    element("moment").textContent =
      live && !isOfFiles(state) ? "now" : `orbit ${about.orbits.toFixed(2)} (${names[Number(time.value)]})`;
    if (isOfFiles(state))
      element("orbits").textContent = `orbit ${about.orbits.toFixed(2)}`;
    element("shown").textContent =
      (about.count < about.of ? `${about.count} of ${about.of} particles` : `All ${about.of} particles`) + stageHelp;
    if (live)
      showRate();
  }

  // A frame is preceded by the state as JSON, with its length in four bytes.
  async function ask(what, live) {
    const buffer = await (await get(what)).arrayBuffer();
    const size = new DataView(buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size)));
    showState(head);
    if (!head.frame)
      return;
    have = head.number;
    showFrame(head.frame, buffer, 4 + size, live);
  }

  const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

  // Resolves when the page can be seen.
  function seen() {
    return document.hidden
      ? new Promise((resolve) => document.addEventListener("visibilitychange", resolve, { once: true })) : null;
  }

  async function follow() {
    for (let failures = 0; failures < 20 && !over;) {
      await seen();
      const begun = performance.now();
      const live = Number(time.value) === Number(time.max), field = choice.value || "speed";
      let interval = frameInterval;
      try {
        if (live) {
          await ask(`frame?colour=${field}&have=${have}`, true);
          asked = "";
          if (isOfFiles(state))
            interval = stateInterval;
        } else if (asked !== `${time.value} ${field}`) {
          asked = `${time.value} ${field}`;
          await ask(`past?k=${time.value}&colour=${field}`, false);
          have = 0;
        } else {
          showState(await (await get("state")).json());
          interval = stateInterval;
        }
        failures = 0;
        say("");
        over = state.stage === "stopped";
      } catch (error) {
        ++failures;
        interval = stateInterval;
        say(error instanceof TypeError ? "The run does not answer any more." : error.message);
      }
      await Promise.race([pause(Math.max(0, interval - (performance.now() - begun))), changed()]);
    }
    element("control").hidden = true;
    if (!over)
      element("stage-name").textContent = "Ended";
  }

  // Resolves at the next choice of the user, which is then not kept waiting.
  let wake = null;
  function changed() {
    return new Promise((resolve) => { wake = resolve; });
  }
  const hurry = () => wake && wake();

  async function followSeries() {
    for (let last = ""; showPlots && !over; await pause(plotInterval)) {
      await seen();
      try {
        const text = await (await get("plots")).text();
        if (text !== last)
          showPlots(JSON.parse(text));
        last = text;
      } catch (error) { // said by follow()
        last = "";
      }
    }
  }

  // --- what the user does

  element("pause").addEventListener("click", () => command(state.paused ? "resume" : "pause"));
  element("step").addEventListener("click", () => command("step"));
  element("stop").addEventListener("click", () => command("stop"));
  limit.addEventListener("input", () => {
    const steps = Number(limit.value) === Number(limit.max) ? 0 : Math.round(10 ** (0.25 * Number(limit.value)));
    command(`limit?steps_per_second=${steps}`);
  });
  time.addEventListener("input", hurry);
  choice.addEventListener("change", () => {
    have = 0;
    hurry();
  });
  document.querySelectorAll("[data-look]").forEach((button) =>
    button.addEventListener("click", () => stage && stage.look(button.dataset.look)));

  paintBar(element("bar"), colours);
  if (!stage && typeof THREE === "undefined")
    say("This program was built without the library three.js, so the particles cannot be shown.");
  follow();
  followSeries();
})();
