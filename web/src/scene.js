// The drawing surface: a renderer that draws only when something changed, two cameras and their controls.
import {
  Box3,
  Color,
  ColorManagement,
  LinearSRGBColorSpace,
  MOUSE,
  OrthographicCamera,
  PerspectiveCamera,
  Raycaster,
  Scene,
  TOUCH,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

// Colours are those of the legend, so they go to the screen as they are.
ColorManagement.enabled = false;

const FIELD_OF_VIEW = 45;
const LARGEST_PIXEL_RATIO = 2;

/**
 * Returns the view of a canvas. `bounds` is {min, max} of the world, relative to the pack's origin. Large worlds are
 * drawn without smooth edges, which would take twice as long.
 */
export function createView(canvas, bounds, shared, isLarge) {
  const uploads = { bytes: 0 };
  const renderer = new WebGLRenderer({ canvas, antialias: !isLarge, powerPreference: 'high-performance' });
  renderer.outputColorSpace = LinearSRGBColorSpace;
  renderer.info.autoReset = false;
  countUploads(renderer.getContext(), uploads);
  const scene = new Scene();
  const box = new Box3(new Vector3(...bounds.min), new Vector3(...bounds.max));
  const center = new Vector3(...bounds.min).add(new Vector3(...bounds.max)).multiplyScalar(0.5);
  const radius = Math.max(new Vector3(...bounds.min).distanceTo(new Vector3(...bounds.max)) / 2, 0.5);
  const perspective = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.1, 1000);
  const orthographic = new OrthographicCamera(-1, 1, 1, -1, 0, 1000);
  for (const camera of [perspective, orthographic]) camera.up.set(0, 0, 1);
  perspective.position.copy(center).add(new Vector3(-1, -1.2, 1).multiplyScalar(radius));
  const controls = new OrbitControls(perspective, canvas);
  controls.target.copy(center);
  controls.zoomToCursor = true;
  controls.maxPolarAngle = Math.PI * 0.96;
  controls.minDistance = 0.05;
  controls.maxDistance = radius * 12;
  controls.screenSpacePanning = false;

  let camera = perspective;
  let asked = false;
  const watchers = [];
  const preparers = [];
  const raycaster = new Raycaster();

  function draw() {
    asked = false;
    const distance = camera.position.distanceTo(controls.target);
    if (camera === perspective) {
      // The nearest place of the world decides how near the camera has to see.
      const outside = Math.max(0, camera.position.distanceTo(center) - radius * 1.1);
      camera.near = Math.max(outside, Math.min(distance, radius) / 200, 0.01);
      camera.far = camera.position.distanceTo(center) + radius * 2;
    } else {
      camera.near = 0;
      camera.far = camera.position.distanceTo(center) + radius * 4;
    }
    camera.updateProjectionMatrix();
    preparers.forEach((prepare) => prepare());
    renderer.info.reset();
    renderer.render(scene, camera);
    watchers.forEach((watch) => watch());
  }

  const view = {
    canvas,
    renderer,
    scene,
    controls,
    uploads,
    center,
    box,
    radius,
    get camera() {
      return camera;
    },
    get isTop() {
      return camera === orthographic;
    },
    requestRender() {
      if (asked) return;
      asked = true;
      requestAnimationFrame(draw);
    },
    renderNow: draw,
    setBackground(color) {
      renderer.setClearColor(new Color(color));
      view.requestRender();
    },
    beforeRender: (prepare) => preparers.push(prepare),
    onRender: (watch) => watchers.push(watch),
    resize() {
      const { clientWidth: width, clientHeight: height } = canvas.parentElement;
      if (width === 0 || height === 0) return;
      const ratio = Math.min(window.devicePixelRatio || 1, LARGEST_PIXEL_RATIO);
      shared.pixelRatio.value = ratio;
      renderer.setPixelRatio(ratio);
      renderer.setSize(width, height, false);
      shared.viewport.value.set(width * ratio, height * ratio);
      perspective.aspect = width / height;
      orthographic.left = -(orthographic.right = (orthographic.top * width) / height);
      view.requestRender();
    },
    /** Changes to the camera of maps (true) or the one with perspective, with about the same part of the world. */
    setTop(top) {
      if (top === view.isTop) return;
      const offset = camera.position.clone().sub(controls.target);
      const shownHeight = top
        ? 2 * offset.length() * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)
        : (orthographic.top - orthographic.bottom) / orthographic.zoom;
      camera = top ? orthographic : perspective;
      if (top) view.setShownHeight(shownHeight);
      const distance = top ? radius * 3 : shownHeight / 2 / Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
      camera.position.copy(controls.target).add(offset.setLength(distance));
      controls.object = camera;
      controls.enableRotate = !top;
      controls.mouseButtons = { LEFT: top ? MOUSE.PAN : MOUSE.ROTATE, MIDDLE: MOUSE.DOLLY, RIGHT: MOUSE.PAN };
      controls.touches = { ONE: top ? TOUCH.PAN : TOUCH.ROTATE, TWO: TOUCH.DOLLY_PAN };
      controls.screenSpacePanning = top;
      controls.update();
      view.resize();
    },
    /** Sets how many metres of the world the top view shows from its lower to its upper edge. */
    setShownHeight(height) {
      orthographic.zoom = 1;
      orthographic.top = height / 2;
      orthographic.bottom = -height / 2;
      orthographic.right = (height / 2) * perspective.aspect;
      orthographic.left = -orthographic.right;
    },
    /** Returns the metres of one CSS pixel at the target of the camera. */
    metresPerPixel() {
      const height = canvas.clientHeight || 1;
      if (view.isTop) return (orthographic.top - orthographic.bottom) / orthographic.zoom / height;
      const distance = camera.position.distanceTo(controls.target);
      return (2 * distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360)) / height;
    },
    /** Returns the device pixels of a metre at the depth of 1 m; in the top view, at each depth. */
    pixelsAtUnitDepth() {
      const pixels = canvas.clientHeight * shared.pixelRatio.value;
      if (view.isTop) return pixels / ((orthographic.top - orthographic.bottom) / orthographic.zoom);
      return pixels / (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360));
    },
    /** Returns the device pixels of a metre at the place of the world that is nearest to the camera. */
    largestScale() {
      if (view.isTop) return view.pixelsAtUnitDepth();
      return view.pixelsAtUnitDepth() / Math.max(box.distanceToPoint(camera.position), 0.01);
    },
    /** Returns {x, y, visible} of a place relative to the origin, in CSS pixels of the canvas. */
    project(place) {
      camera.updateMatrixWorld();
      camera.updateProjectionMatrix();
      const seen = new Vector3(...place).project(camera);
      return {
        x: ((seen.x + 1) / 2) * canvas.clientWidth,
        y: ((1 - seen.y) / 2) * canvas.clientHeight,
        visible: Math.abs(seen.z) <= 1,
      };
    },
    /** Returns the ray into the world at a CSS pixel of the canvas. */
    rayAt(x, y) {
      camera.updateMatrixWorld();
      const at = new Vector2((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight);
      raycaster.setFromCamera(at, camera);
      return raycaster.ray.clone();
    },
  };
  controls.addEventListener('change', view.requestRender);
  new ResizeObserver(view.resize).observe(canvas.parentElement);
  return view;
}

// Counts the bytes that go to the graphics memory, at the calls that send them.
function countUploads(gl, uploads) {
  const bufferData = gl.bufferData.bind(gl);
  gl.bufferData = (target, data, ...others) => {
    uploads.bytes += typeof data === 'number' ? 0 : (data?.byteLength ?? 0);
    bufferData(target, data, ...others);
  };
  for (const name of ['bufferSubData', 'texImage2D', 'texSubImage2D']) {
    const call = gl[name].bind(gl);
    gl[name] = (...values) => {
      uploads.bytes += values.find((value) => ArrayBuffer.isView(value))?.byteLength ?? 0;
      call(...values);
    };
  }
}
