// Particles in three dimensions, as spheres at true scale. Each is drawn as a point sprite that faces the viewer, with
// the shading and depth of a sphere: 10⁵ particles need no triangle meshes. The numbers of a frame go to the graphics
// card as they come.
"use strict";

// Returns the stage in an element, or null in a browser without WebGL. `colours` are the 256 colours of the bar, three
// bytes each.
function makeStage(parent, colours) {
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    parent.textContent = "";
    parent.appendChild(document.createElement("p")).textContent =
      "This browser has no WebGL, so the particles cannot be shown.";
    return null;
  }
  parent.appendChild(renderer.domElement);

  const palette = new THREE.DataTexture(colours, 256, 1, THREE.RGBFormat);
  palette.needsUpdate = true;
  const material = new THREE.RawShaderMaterial({
    uniforms: {
      pixels: { value: 1 },
      low: { value: new THREE.Vector3() },
      extent: { value: new THREE.Vector4() },
      palette: { value: palette },
    },
    extensions: { fragDepth: renderer.extensions.get("EXT_frag_depth") !== null },
    vertexShader: `
      precision highp float;
      uniform mat4 modelViewMatrix;
      uniform mat4 projectionMatrix;
      uniform float pixels; // per metre, at a distance of one metre
      uniform vec3 low;
      uniform vec4 extent; // of x, y, z and radius
      uniform sampler2D palette;
      attribute vec4 position; // place and radius, from 0 to 1
      attribute float tone;
      varying vec3 colour;
      varying float size;
      varying vec3 middle;
      void main() {
        vec4 seen = modelViewMatrix * vec4(low + extent.xyz * position.xyz, 1.0);
        colour = texture2D(palette, vec2((255.0 * tone + 0.5) / 256.0, 0.5)).rgb;
        size = extent.w * position.w;
        middle = seen.xyz;
        gl_Position = projectionMatrix * seen;
        gl_PointSize = max(1.0, 2.0 * size * pixels / -seen.z);
      }`,
    fragmentShader: `
      precision highp float;
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
  let geometry = null, cloud = null, outline = null;
  let sizeX = 1, sizeY = 1;

  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(30, 1, 1, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, renderer.domElement);
  controls.screenSpacePanning = true;

  let waiting = false;
  function draw() {
    renderer.render(scene, camera);
  }
  // Draws once before the next picture of the screen, however often it is called.
  function drawSoon() {
    if (waiting)
      return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      draw();
    });
  }
  controls.addEventListener("change", draw);

  function setBox([x, y]) {
    if (outline && x === sizeX && y === sizeY)
      return false;
    [sizeX, sizeY] = [x, y];
    if (outline)
      scene.remove(outline);
    const corners = new THREE.BufferGeometry();
    corners.setAttribute("position", new THREE.BufferAttribute(new Float32Array(
      [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].flatMap(([u, v]) => [0.5 * u * x, 0.5 * v * y, 0])), 3));
    outline = new THREE.Line(corners, new THREE.LineBasicMaterial({ color: 0x556070 }));
    scene.add(outline);
    const reach = 0.5 * Math.hypot(x, y);
    camera.near = 1e-3 * reach;
    camera.far = 100 * reach;
    camera.updateProjectionMatrix();
    controls.minDistance = 0.01 * reach;
    controls.maxDistance = 40 * reach;
    return true;
  }

  // Shows particles: `places` has x, y, z and radius in units above `low`, `tones` the numbers of their colours.
  function setParticles({ places, tones, low, unit }) {
    const n = tones.length;
    if (!geometry || geometry.getAttribute("tone").count !== n) {
      if (cloud) {
        scene.remove(cloud);
        geometry.dispose();
      }
      geometry = new THREE.BufferGeometry();
      for (const [name, type, size] of [["position", Uint16Array, 4], ["tone", Uint8Array, 1]])
        geometry.setAttribute(name, new THREE.BufferAttribute(new type(size * n), size, true).setUsage(THREE.DynamicDrawUsage));
      cloud = new THREE.Points(geometry, material);
      cloud.frustumCulled = false;
      scene.add(cloud);
    }
    for (const [name, numbers] of [["position", places], ["tone", tones]]) {
      const attribute = geometry.getAttribute(name);
      attribute.array = numbers;
      attribute.needsUpdate = true;
    }
    material.uniforms.low.value.set(...low);
    material.uniforms.extent.value.set(...unit.map((part) => 65535 * part));
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
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(parent.clientWidth, parent.clientHeight);
    camera.aspect = parent.clientWidth / parent.clientHeight;
    camera.updateProjectionMatrix();
    material.uniforms.pixels.value =
      0.5 * parent.clientHeight * window.devicePixelRatio / Math.tan(0.5 * camera.fov * Math.PI / 180);
    draw();
  }

  new ResizeObserver(fit).observe(parent);
  return { setBox: setBox, setParticles: setParticles, look: look, fit: fit, draw: draw, drawSoon: drawSoon };
}

// Paints the colours of a bar into a canvas of 256 by 1.
function paintBar(canvas, colours) {
  const pen = canvas.getContext("2d"), pixels = pen.createImageData(256, 1);
  for (let k = 0; k < 256; ++k)
    pixels.data.set([colours[3 * k], colours[3 * k + 1], colours[3 * k + 2], 255], 4 * k);
  pen.putImageData(pixels, 0, 0);
}

const stageHelp = " at true scale. Drag to rotate, drag with the right button to move, use the wheel to zoom.";
