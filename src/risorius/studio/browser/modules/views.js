// Renderer, camera, lights, and the layouts: one view, two side by side, nine to choose from.
import { OrbitControls, THREE } from "nicegui-scene";

const BACKGROUND = 0x1b1d20, LINE = 0x2c3036;
const ANGLE = 24, NARROW = 0.85; // degrees; width over height
const NEAR = 0.76; // nine small faces are seen from nearer
const OTHER = 0.05; // of the height: a head that differs by more is another one
const PRESETS = {
  front: [0, 0.02, 1], three_quarter: [0.62, 0.08, 0.78], left: [1, 0.02, 0.02],
  right: [-1, 0.02, 0.02], mouth: [0, 0, 1], eyes: [0, 0, 1],
};

export class Views {
  constructor(viewport) {
    this.viewport = viewport;
    this.renderer = new THREE.WebGLRenderer({
      canvas: viewport.canvas, antialias: true, powerPreference: "high-performance",
    });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(ANGLE, 1, 10, 4000);
    this.camera.position.set(0, 0, 900);
    const scene = viewport.meshes.scene;
    scene.add(new THREE.HemisphereLight(0xf2f4ff, 0x4a4038, 1.15));
    this.key = new THREE.DirectionalLight(0xfff3e6, 1.9);
    this.fill = new THREE.DirectionalLight(0xdbe6ff, 0.55);
    this.rim = new THREE.DirectionalLight(0xffffff, 0.5);
    for (const light of [this.key, this.fill, this.rim]) scene.add(light, light.target);
    this.orbit = new OrbitControls(this.camera, viewport.canvas);
    this.orbit.enableDamping = false;
    this.orbit.addEventListener("change", viewport.touch);
    this.facts = { centre: [0, 0, 0], height: 230, spots: {} };
    this.framed = false;
    this.marks = [];
    this.size = [0, 0];
  }

  frame(facts) {
    const before = this.facts, apart = facts.centre.map((x, k) => x - before.centre[k]);
    const other = Math.hypot(...apart) > OTHER * before.height
      || Math.abs(facts.height / before.height - 1) > OTHER;
    this.facts = facts;
    if (!this.framed || other) this.look("three_quarter");
    this.framed = true;
  }

  look(preset) {
    const { centre, height, spots } = this.facts;
    const spot = spots[preset];
    const target = new THREE.Vector3(...(spot || centre));
    const direction = new THREE.Vector3(...(PRESETS[preset] || PRESETS.front)).normalize();
    const distance = (spot ? 0.85 : 2.9) * height;
    this.orbit.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.camera.up.set(0, 1, 0);
    this.orbit.update();
    this.viewport.touch();
  }

  // Rectangles in CSS pixels from the top left: [x, y, width, height, what].
  rectangles() {
    const [w, h] = this.size, layout = this.viewport.settings.layout;
    if (layout === "two") return [[0, 0, w / 2, h, 2], [w / 2, 0, w / 2, h, 1]];
    if (layout === "nine" && this.viewport.meshes.sets.length) {
      return this.viewport.meshes.sets.map((_, k) => [
        ((k % 3) * w) / 3, (Math.floor(k / 3) * h) / 3, w / 3, h / 3, k,
      ]);
    }
    return [[0, 0, w, h, 0]];
  }

  nine() {
    return this.viewport.settings.layout === "nine" && this.viewport.meshes.sets.length > 0;
  }

  at(x, y) {
    return this.rectangles().find(([l, t, w, h]) => x >= l && x < l + w && y >= t && y < t + h);
  }

  resize() {
    const root = this.viewport.root;
    const w = Math.max(root.clientWidth, 2), h = Math.max(root.clientHeight, 2);
    if (w === this.size[0] && h === this.size[1]) return;
    this.size = [w, h];
    this.renderer.setSize(w, h, false);
  }

  draw() {
    this.resize();
    const meshes = this.viewport.meshes, nine = this.nine(), height = this.size[1];
    this.light();
    this.renderer.setClearColor(LINE);
    this.renderer.setScissor(0, 0, this.size[0], height);
    this.renderer.clear();
    const rectangles = this.rectangles(), gap = rectangles.length > 1 ? 1 : 0;
    for (const [left, top, w, h, what] of rectangles) {
      const marked = nine && this.marks.includes(what);
      if (nine) meshes.showSet(what);
      else meshes.showFor(what);
      this.viewport.overlay.group.visible = !nine;
      this.renderer.setClearColor(marked ? 0x2d4a3a : BACKGROUND);
      this.aim(w, h);
      const inset = gap + (marked ? 2 : 0);
      this.renderer.setViewport(left, height - top - h, w, h);
      this.renderer.setScissor(
        left + inset, height - top - h + inset, w - 2 * inset, h - 2 * inset,
      );
      this.renderer.render(meshes.scene, this.camera);
    }
    this.viewport.overlay.name(nine ? rectangles : [], this.marks);
  }

  aim(w, h) {
    const aspect = w / h, half = Math.tan((ANGLE * Math.PI) / 360);
    this.camera.aspect = aspect;
    // A narrow view shows as much across as a square one.
    const fit = half * Math.max(1, NARROW / aspect) * (this.nine() ? NEAR : 1);
    this.camera.fov = (Math.atan(fit) * 360) / Math.PI;
    this.camera.updateProjectionMatrix();
  }

  light() {
    const eye = this.camera.position, target = this.orbit.target;
    const away = eye.clone().sub(target).normalize();
    const side = new THREE.Vector3().crossVectors(this.camera.up, away).normalize();
    const up = new THREE.Vector3().crossVectors(away, side);
    const put = (light, f, s, u) => {
      light.target.position.copy(target);
      light.position.copy(target).addScaledVector(away, f * 500)
        .addScaledVector(side, s * 500).addScaledVector(up, u * 500);
      light.target.updateMatrixWorld();
    };
    put(this.key, 0.9, -0.55, 0.75);
    put(this.fill, 0.7, 0.9, -0.1);
    put(this.rim, -1, 0.3, 0.6);
  }

  ray(x, y) {
    const view = this.at(x, y);
    if (!view) return null;
    const [left, top, w, h, what] = view;
    this.aim(w, h);
    this.camera.updateMatrixWorld();
    const caster = new THREE.Raycaster();
    const place = new THREE.Vector2(((x - left) / w) * 2 - 1, 1 - ((y - top) / h) * 2);
    caster.setFromCamera(place, this.camera);
    return { caster, mode: this.nine() ? 0 : what, what };
  }

  project(x, y, z) {
    const [left, top, w, h] = this.rectangles()[0];
    this.aim(w, h);
    this.camera.updateMatrixWorld();
    const at = new THREE.Vector3(x, y, z).project(this.camera);
    return {
      x: left + ((at.x + 1) / 2) * w, y: top + ((1 - at.y) / 2) * h, front: at.z < 1,
    };
  }

  close() {
    this.orbit.dispose();
    this.renderer.dispose();
  }
}
