// The particles of the snapshots in three dimensions, as spheres at true scale. Each is drawn as a point sprite that
// faces the viewer, with the shading and depth of a sphere: 10⁵ particles need no triangle meshes.
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

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    element("stage").innerHTML = "<p>This browser has no WebGL, so the particles cannot be shown.</p>";
    return;
  }
  element("stage").appendChild(renderer.domElement);

  const geometry = new THREE.BufferGeometry();
  const positions = new THREE.BufferAttribute(new Float32Array(3 * n), 3);
  const tints = new THREE.BufferAttribute(new Uint8Array(3 * n), 3, true);
  geometry.setAttribute("position", positions);
  geometry.setAttribute("tint", tints);
  geometry.setAttribute("radius", new THREE.BufferAttribute(radii, 1));

  const material = new THREE.ShaderMaterial({
    uniforms: { pixels: { value: 1 } },
    extensions: { fragDepth: renderer.extensions.get("EXT_frag_depth") !== null },
    vertexShader: `
      attribute vec3 tint;
      attribute float radius;
      uniform float pixels; // per metre, at a distance of one metre
      varying vec3 colour;
      varying float size;
      varying vec3 middle;
      void main() {
        vec4 seen = modelViewMatrix * vec4(position, 1.0);
        colour = tint;
        size = radius;
        middle = seen.xyz;
        gl_Position = projectionMatrix * seen;
        gl_PointSize = max(1.0, 2.0 * radius * pixels / -seen.z);
      }`,
    fragmentShader: `
      uniform mat4 projectionMatrix;
      varying vec3 colour;
      varying float size;
      varying vec3 middle;
      void main() {
        vec2 p = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
        float outside = dot(p, p);
        if (outside > 1.0)
          discard;
        vec3 normal = vec3(p, sqrt(1.0 - outside));
        float light = 0.35 + 0.65 * max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
        gl_FragColor = vec4(colour * light, 1.0);
        #ifdef GL_EXT_frag_depth
          vec4 at = projectionMatrix * vec4(middle + size * normal, 1.0);
          gl_FragDepthEXT = 0.5 * at.z / at.w + 0.5;
        #endif
      }`,
  });
  const cloud = new THREE.Points(geometry, material);
  cloud.frustumCulled = false;

  const scene = new THREE.Scene();
  scene.add(cloud);
  const [sizeX, sizeY] = data.box_m;
  const outline = new THREE.BufferGeometry();
  outline.setAttribute("position", new THREE.BufferAttribute(new Float32Array(
    [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].flatMap(([x, y]) => [0.5 * x * sizeX, 0.5 * y * sizeY, 0])), 3));
  scene.add(new THREE.Line(outline, new THREE.LineBasicMaterial({ color: 0x556070 })));

  const reach = 0.5 * Math.hypot(sizeX, sizeY);
  const camera = new THREE.PerspectiveCamera(30, 1, 1e-3 * reach, 100 * reach);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;
  controls.minDistance = 0.01 * reach;
  controls.maxDistance = 40 * reach;
  controls.addEventListener("change", draw);

  function draw() {
    renderer.render(scene, camera);
  }

  // Fits the patch to the stage, whatever its aspect ratio. From above, x points to the right and y upward.
  const directions = { above: [0, -1e-3, 1], edge: [0, -1, 0.02], oblique: [-0.35, -0.8, 0.55] };
  function look(name) {
    const direction = new THREE.Vector3(...directions[name]).normalize();
    const tall = Math.tan(0.5 * camera.fov * Math.PI / 180), wide = tall * camera.aspect;
    const right = new THREE.Vector3(0, 0, 1).cross(direction).normalize();
    const up = direction.clone().cross(right);
    let distance = 0; // at which all corners are within the frame
    for (const [x, y] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
      const corner = new THREE.Vector3(0.53 * x * sizeX, 0.53 * y * sizeY, 0);
      const aside = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(up)) / tall);
      distance = Math.max(distance, aside + corner.dot(direction));
    }
    controls.target.set(0, 0, 0);
    camera.position.copy(direction.multiplyScalar(distance));
    controls.update();
    draw();
  }

  function fit() {
    const stage = element("stage");
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(stage.clientWidth, stage.clientHeight);
    camera.aspect = stage.clientWidth / stage.clientHeight;
    camera.updateProjectionMatrix();
    material.uniforms.pixels.value =
      0.5 * stage.clientHeight * window.devicePixelRatio / Math.tan(0.5 * camera.fov * Math.PI / 180);
    draw();
  }

  function setPositions(snapshot) {
    const units = new Uint16Array(bytes(snapshot.places).buffer);
    for (let k = 0; k < n; ++k)
      for (let axis = 0; axis < 3; ++axis)
        positions.array[3 * k + axis] = data.low_m[axis] + data.unit_m[axis] * units[axis * n + k];
    positions.needsUpdate = true;
  }

  // Returns the heights, from the positions. The colour bar spans their 1st to 99th percentile.
  function heights() {
    const all = new Float32Array(n);
    for (let k = 0; k < n; ++k)
      all[k] = positions.array[3 * k + 2];
    const sorted = Float32Array.from(all).sort();
    const low = sorted[Math.floor(0.01 * (n - 1))], high = sorted[Math.ceil(0.99 * (n - 1))];
    const scale = high > low ? 255 / (high - low) : 0;
    return { range: { low: low, high: high }, bytes: all.map((z) => Math.min(255, Math.max(0, scale * (z - low)))) };
  }

  function colour(field, moment) {
    const shown = field ? { range: field.range, bytes: bytes(field.bytes[Math.min(moment, field.bytes.length - 1)]) }
      : heights();
    for (let k = 0; k < n; ++k) {
      const from = 3 * Math.floor(shown.bytes[k]);
      for (let channel = 0; channel < 3; ++channel)
        tints.array[3 * k + channel] = colours[from + channel];
    }
    tints.needsUpdate = true;
    element("low").textContent = Number(shown.range.low).toPrecision(3);
    element("high").textContent = Number(shown.range.high).toPrecision(3);
    element("quantity").textContent = field ? field.label : data.height_label;
  }

  const time = element("time"), choice = element("field");
  function show() {
    const moment = Number(time.value), snapshot = data.snapshots[moment];
    setPositions(snapshot);
    colour(data.fields[Number(choice.value)], moment);
    element("moment").textContent = `orbit ${snapshot.time_orbits.toFixed(2)} (${snapshot.file})`;
    draw();
  }

  function fill() {
    const names = ["height"].concat(data.fields.map((field) => field.name));
    names.forEach((name, k) => choice.add(new Option(name, String(k - 1))));
    time.max = String(data.snapshots.length - 1);
    time.value = time.max;
    const pen = element("bar").getContext("2d"), pixels = pen.createImageData(256, 1);
    for (let k = 0; k < 256; ++k)
      pixels.data.set([colours[3 * k], colours[3 * k + 1], colours[3 * k + 2], 255], 4 * k);
    pen.putImageData(pixels, 0, 0);
    element("shown").textContent = (n < data.of ? `${n} of ${data.of} particles` : `All ${n} particles`) +
      " at true scale. Drag to rotate, drag with the right button to move, use the wheel to zoom.";
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
    button.addEventListener("click", () => look(button.dataset.look)));
  window.addEventListener("resize", fit);

  fill();
  fit();
  show();
  look("oblique");
})();
