// Meshes by name, in groups: brought by scenes, moved and painted by frames.
import { THREE } from "nicegui-scene";
import { Morph } from "./morph.js";

const STEP = 1 / 256;
const ORDER = { skull: 0, muscles: 1, parts: 2, skin: 3 };
// Vertices move by less than this, so that picking need not measure meshes again [mm].
const REACH = 60;
const LINEAR = Float32Array.from({ length: 256 }, (_, k) => {
  const v = k / 255;
  return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
});

const deep = (group) => group === "skull" || group === "muscles";
const padded = (count) => count + ((4 - (count % 4)) % 4);

const MATERIALS = {
  skin: { roughness: 0.58 }, parts: { roughness: 0.35 },
  skull: { roughness: 0.75 }, muscles: { roughness: 0.5 },
};

export class MeshBook {
  constructor(touch) {
    this.touch = touch;
    this.scene = new THREE.Scene();
    // Everything that turns with the head.
    this.root = new THREE.Group();
    this.root.matrixAutoUpdate = false;
    this.scene.add(this.root);
    this.morph = new Morph();
    this.byName = new Map();
    this.sets = [];
    this.settings = null;
  }

  replace(head, data, offset) {
    this.morph.drop();
    for (const [name, entry] of [...this.byName]) {
      if (head.replaced.includes(entry.group)) this.remove(name);
    }
    for (const entry of head.meshes) {
      const count = entry.vertices * 3;
      const rest = new Float32Array(data.slice(offset, offset + count * 4));
      offset += count * 4;
      const faces = new Uint32Array(data.slice(offset, offset + entry.faces * 12));
      offset += entry.faces * 12;
      const paint = linear(new Uint8Array(data, offset, count));
      offset += padded(count);
      this.add(entry, rest, faces, paint);
    }
    if (head.replaced.includes("skin")) this.drop();
  }

  add(entry, rest, faces, paint) {
    this.remove(entry.name);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(rest.slice(), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(paint.slice(), 3));
    geometry.setIndex(new THREE.BufferAttribute(faces, 1));
    geometry.computeVertexNormals();
    geometry.computeBoundingSphere();
    geometry.boundingSphere.radius += REACH;
    const material = new THREE.MeshStandardMaterial({
      vertexColors: true, metalness: 0, ...MATERIALS[entry.group],
      side: deep(entry.group) || entry.solid < 1 ? THREE.DoubleSide : THREE.FrontSide,
    });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.name = entry.name;
    mesh.frustumCulled = false;
    mesh.renderOrder = ORDER[entry.group];
    this.morph.patch(entry.name, material);
    this.root.add(mesh);
    const { group, solid } = entry;
    this.byName.set(entry.name, { mesh, group, solid, rest, paint, painted: false });
  }

  remove(name) {
    const entry = this.byName.get(name);
    if (!entry) return;
    this.root.remove(entry.mesh);
    this.morph.forget(name);
    entry.mesh.geometry.dispose();
    entry.mesh.material.dispose();
    this.byName.delete(name);
  }

  // Turn the whole head about a point: its place and a quaternion (x, y, z, w), or nothing.
  turn(numbers) {
    const [a, b, c, ...q] = numbers || [0, 0, 0, 0, 0, 0, 1];
    const pivot = new THREE.Vector3(a, b, c), turn = new THREE.Quaternion(...q);
    const shift = pivot.clone().sub(pivot.clone().applyQuaternion(turn));
    this.root.matrix.compose(shift, turn, new THREE.Vector3(1, 1, 1));
    this.root.matrixWorldNeedsUpdate = true;
  }

  // Places of a mesh as they are shown, three numbers for each vertex.
  shown(name, renderer) {
    const entry = this.byName.get(name);
    const moved = this.morph.active && this.morph.first.has(name);
    if (moved) return this.morph.read(name, entry.rest.length / 3, renderer);
    return entry.mesh.geometry.attributes.position.array;
  }

  move(head, data, offset) {
    if (!this.morph.active) this.turn(head.turn);
    for (const name of head.moved) {
      const entry = this.byName.get(name);
      if (!entry) return;
      const count = entry.rest.length;
      const steps = new Int16Array(data, offset, count);
      const attribute = entry.mesh.geometry.attributes.position;
      const target = attribute.array;
      for (let i = 0; i < count; i++) target[i] = entry.rest[i] + steps[i] * STEP;
      attribute.needsUpdate = true;
      entry.mesh.geometry.computeVertexNormals();
      offset += padded(count * 2);
    }
    const painted = new Set(head.painted);
    for (const [name, entry] of this.byName) {
      if (painted.has(name) || !entry.painted) continue;
      this.colour(entry, entry.paint);
      entry.painted = false;
    }
    for (const name of head.painted) {
      const entry = this.byName.get(name);
      if (!entry) return;
      this.colour(entry, linear(new Uint8Array(data, offset, entry.rest.length)));
      entry.painted = true;
      offset += padded(entry.rest.length);
    }
  }

  colour(entry, paint) {
    entry.mesh.geometry.attributes.color.array.set(paint);
    entry.mesh.geometry.attributes.color.needsUpdate = true;
  }

  // Faces to choose from: each a set of meshes that share everything but their positions.
  bring(head, data, offset) {
    this.drop();
    for (let k = 0; k < head.count; k++) {
      const set = new THREE.Group();
      for (const name of head.moved) {
        const entry = this.byName.get(name);
        if (!entry) return;
        const count = entry.rest.length;
        const steps = new Int16Array(data, offset, count);
        const places = new Float32Array(count);
        for (let i = 0; i < count; i++) places[i] = entry.rest[i] + steps[i] * STEP;
        const geometry = new THREE.BufferGeometry();
        geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
        geometry.setAttribute("color", new THREE.BufferAttribute(entry.paint, 3));
        geometry.setIndex(entry.mesh.geometry.index);
        geometry.computeVertexNormals();
        const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({
          vertexColors: true, metalness: 0, ...MATERIALS[entry.group],
          transparent: entry.solid < 1, opacity: entry.solid, depthWrite: entry.solid === 1,
        }));
        mesh.frustumCulled = false;
        set.add(mesh);
        offset += padded(count * 2);
      }
      set.visible = false;
      this.scene.add(set);
      this.sets.push(set);
    }
    this.labels = head.labels;
  }

  drop() {
    for (const set of this.sets) {
      this.scene.remove(set);
      for (const mesh of set.children) {
        mesh.geometry.setIndex(null);
        mesh.geometry.dispose();
        mesh.material.dispose();
      }
    }
    this.sets = [];
  }

  apply(settings) {
    this.settings = settings;
    for (const [name, entry] of this.byName) {
      const material = entry.mesh.material;
      const chosen = settings.selected && name === settings.selected;
      material.emissive.setHex(chosen ? 0x7a4a10 : 0x000000);
    }
    this.touch();
  }

  // Whether a mesh shows: in the only view (0), the inner (1) or the outer of two (2).
  shows(name, mode) {
    const entry = this.byName.get(name), settings = this.settings;
    if (!entry || !settings) return false;
    if (settings.hidden.includes(name)) return false;
    if (mode) return deep(entry.group) === (mode === 1);
    return (settings.opacity[entry.group] ?? 1) > 0.001;
  }

  showFor(mode) {
    for (const [name, entry] of this.byName) {
      entry.mesh.visible = this.shows(name, mode);
      const opacity = entry.solid * (mode ? 1 : this.settings?.opacity[entry.group] ?? 1);
      const material = entry.mesh.material, clear = opacity < 0.999;
      material.opacity = opacity;
      if (material.transparent !== clear) {
        material.transparent = clear;
        material.depthWrite = !clear;
        material.needsUpdate = true;
      }
    }
    for (const set of this.sets) set.visible = false;
  }

  showSet(index) {
    for (const entry of this.byName.values()) entry.mesh.visible = false;
    this.sets.forEach((set, k) => { set.visible = k === index; });
  }

  // Meshes that a pointer may hit: those of `groups` (or names) that show.
  targets(groups, mode) {
    const result = [];
    for (const [name, entry] of this.byName) {
      if (!this.shows(name, mode)) continue;
      if (groups.includes(entry.group) || groups.includes(name)) result.push(entry.mesh);
    }
    return result;
  }

  groupOf(name) {
    return this.byName.get(name)?.group;
  }
}

function linear(bytes) {
  const result = new Float32Array(bytes.length);
  for (let i = 0; i < bytes.length; i++) result[i] = LINEAR[bytes[i]];
  return result;
}
