// What lies over the meshes: lines, handles that can be dragged, names.
import { THREE } from "nicegui-scene";

const disc = (() => {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 32;
  const pen = canvas.getContext("2d");
  pen.beginPath();
  pen.arc(16, 16, 12, 0, 7);
  pen.fillStyle = "#fff";
  pen.fill();
  pen.lineWidth = 4;
  pen.strokeStyle = "rgba(0,0,0,.75)";
  pen.stroke();
  return new THREE.CanvasTexture(canvas);
})();

// Round points of a size in pixels, before everything else.
function cloud(places, size) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(
    places.flatMap((p) => p.at), 3,
  ));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(
    places.flatMap((p) => new THREE.Color(p.colour).toArray()), 3,
  ));
  const points = new THREE.Points(geometry, new THREE.PointsMaterial({
    size, sizeAttenuation: false, map: disc, vertexColors: true, alphaTest: 0.4,
    transparent: true, depthTest: false,
  }));
  points.renderOrder = 11;
  points.frustumCulled = false;
  return points;
}

export class Overlay {
  constructor(viewport) {
    this.viewport = viewport;
    this.group = new THREE.Group();
    viewport.meshes.scene.add(this.group);
    this.handles = [];
    this.points = null;
    this.cursor = new THREE.Mesh(
      new THREE.SphereGeometry(1.3, 12, 8),
      new THREE.MeshBasicMaterial({ color: 0xffd166, depthTest: false, transparent: true }),
    );
    this.cursor.renderOrder = 12;
    this.cursor.visible = false;
    this.group.add(this.cursor);
    this.lines = new THREE.Group();
    this.group.add(this.lines);
    this.labels = viewport.root.querySelector(".rv-labels");
    this.tip = viewport.root.querySelector(".rv-tip");
  }

  show({ handles = [], lines = [], segments = [], dots = [] }) {
    for (const line of [...this.lines.children]) {
      this.lines.remove(line);
      line.geometry.dispose();
      line.material.dispose();
    }
    for (const { points, colour, width = 0.7, through = true } of lines) {
      if (points.length < 2) continue;
      const path = new THREE.CurvePath();
      for (let k = 1; k < points.length; k++) {
        path.add(new THREE.LineCurve3(
          new THREE.Vector3(...points[k - 1]), new THREE.Vector3(...points[k]),
        ));
      }
      const tube = new THREE.Mesh(
        new THREE.TubeGeometry(path, Math.min(4 * points.length, 200), width, 5, false),
        new THREE.MeshBasicMaterial({
          color: new THREE.Color(colour), depthTest: !through, transparent: true, opacity: 0.95,
        }),
      );
      tube.renderOrder = 10;
      tube.frustumCulled = false;
      this.lines.add(tube);
    }
    for (const { points, colour } of segments) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
      const net = new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({
        color: new THREE.Color(colour), depthTest: false, transparent: true, opacity: 0.9,
      }));
      net.renderOrder = 10;
      net.frustumCulled = false;
      this.lines.add(net);
    }
    if (dots.length) this.lines.add(cloud(dots, 7));
    this.handles = handles;
    // A handle that is being dragged stays under the pointer.
    const held = this.viewport.pointer?.dragged, twin = held && handles.find((h) => h.id === held.id);
    if (twin) {
      twin.at = held.at;
      this.viewport.pointer.dragged = twin;
    }
    this.dots();
    this.viewport.touch();
  }

  // Show a clicked place at once; the studio's answer takes its place.
  promise(point) {
    this.handles = [...this.handles, { id: "", at: point.toArray(), normal: null, on: null,
      colour: "#ffd166", label: "" }];
    this.dots();
    this.viewport.touch();
  }

  dots() {
    if (this.points) {
      this.group.remove(this.points);
      this.points.geometry.dispose();
      this.points.material.dispose();
      this.points = null;
    }
    if (!this.handles.length) return;
    this.points = cloud(this.handles, 11);
    this.group.add(this.points);
    this.facing();
  }

  // Handles on the far side are not shown and cannot be taken.
  facing() {
    if (!this.points) return;
    const eye = this.viewport.views.camera.position, places = this.points.geometry.attributes.position;
    this.handles.forEach((handle, k) => {
      const n = handle.normal;
      handle.seen = !n || (eye.x - handle.at[0]) * n[0] + (eye.y - handle.at[1]) * n[1]
        + (eye.z - handle.at[2]) * n[2] > 0;
      if (handle.seen) places.setXYZ(k, ...handle.at);
      else places.setXYZ(k, 0, 1e6, 0);
    });
    places.needsUpdate = true;
  }

  place() {
    this.facing();
  }

  nearest(x, y, reach = 10) {
    let best = null, least = reach;
    for (const handle of this.handles) {
      if (!handle.seen) continue;
      const at = this.viewport.views.project(...handle.at);
      const distance = Math.hypot(at.x - x, at.y - y);
      if (at.front && distance < least) [best, least] = [handle, distance];
    }
    return best;
  }

  moveHandle(handle, point) {
    handle.at = point.toArray();
    this.viewport.touch();
  }

  point(place) {
    this.cursor.visible = Boolean(place);
    if (place) {
      this.cursor.position.copy(place);
      const eye = this.viewport.views.camera.position;
      this.cursor.scale.setScalar(Math.max(eye.distanceTo(place) / 700, 0.2));
    }
    this.viewport.touch();
  }

  say(text, x, y) {
    this.tip.textContent = text;
    this.tip.style.display = text ? "block" : "none";
    this.tip.style.transform = `translate(${Math.round(x + 14)}px, ${Math.round(y + 10)}px)`;
  }

  name(rectangles, marks) {
    const texts = this.viewport.meshes.labels || [];
    const key = JSON.stringify([rectangles, marks, texts]);
    if (key === this.named) return;
    this.named = key;
    this.labels.replaceChildren(...rectangles.map(([left, top, , , k]) => {
      const label = document.createElement("div");
      const rank = marks.indexOf(k);
      label.textContent = (texts[k] ?? k + 1) + (rank >= 0 ? `  ✓ ${rank + 1}` : "");
      label.className = rank >= 0 ? "rv-label rv-chosen" : "rv-label";
      label.style.transform = `translate(${left + 10}px, ${top + 8}px)`;
      return label;
    }));
  }
}
