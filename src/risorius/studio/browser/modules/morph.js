// Targets of all meshes on the graphics card: weights go in, places and normals of vertices come
// out as textures that the materials read. Each vertex has a list of the targets that move it.
import { THREE } from "nicegui-scene";

const WIDTH = 1024; // texels in a row: of vertices
const LONG = 4096; // of lists
const HEAD = `
  precision highp float; precision highp int;
  precision highp sampler2D; precision highp isampler2D; precision highp usampler2D;
  uniform sampler2D places, weights;
  uniform usampler2D starts;
  uniform highp isampler2D entries;
  out vec4 result;
  ivec2 at(int i, int width) { return ivec2(i % width, i / width); }
  int start(int i) { return int(texelFetch(starts, at(i, ${WIDTH}), 0).r); }
  vec3 place(int i) { return texelFetch(places, at(i, ${WIDTH}), 0).xyz; }
  int own() { return int(gl_FragCoord.y) * ${WIDTH} + int(gl_FragCoord.x); }`;
// Rest and, entry by entry, what the targets add.
const MOVE = `${HEAD}
  void main() {
    int i = own(), last = start(i + 1);
    vec3 p = place(i);
    for (int k = start(i); k < last; k++) {
      ivec4 entry = texelFetch(entries, at(k, ${LONG}), 0);
      p += texelFetch(weights, ivec2(entry.x, 0), 0).r * vec3(entry.yzw);
    }
    result = vec4(p, 1.0);
  }`;
// Normals of the faces around a vertex, weighted by area, as on meshes that the studio moves.
const TURN = `${HEAD}
  void main() {
    int i = own(), last = start(i + 1);
    vec3 p = place(i), n = vec3(0.0);
    for (int k = start(i); k < last; k++) {
      ivec2 pair = texelFetch(entries, at(k, ${LONG}), 0).xy;
      n += cross(place(pair.x) - p, place(pair.y) - p);
    }
    result = vec4(n / max(length(n), 1e-20), 0.0);
  }`;
const FULL = `void main() {
    gl_Position = vec4(vec2[3](vec2(-1, -1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0.0, 1.0);
  }`;
const READ = `uniform highp sampler2D morphPlaces, morphNormals;
  uniform int morphBase;
  ivec2 morphAt() { int i = morphBase + gl_VertexID; return ivec2(i % ${WIDTH}, i / ${WIDTH}); }
  `;

export class Morph {
  constructor() {
    this.places = { value: null };
    this.normals = { value: null };
    this.bases = new Map();
    this.first = new Map();
    this.active = false;
  }

  // Let a material take its vertices from here while this is active.
  patch(name, material) {
    const base = { value: -1 };
    this.bases.set(name, base);
    material.onBeforeCompile = (shader) => {
      shader.uniforms.morphPlaces = this.places;
      shader.uniforms.morphNormals = this.normals;
      shader.uniforms.morphBase = base;
      shader.vertexShader = READ + shader.vertexShader
        .replace("#include <beginnormal_vertex>", `#include <beginnormal_vertex>
          if (morphBase >= 0) objectNormal = texelFetch(morphNormals, morphAt(), 0).xyz;`)
        .replace("#include <begin_vertex>", `#include <begin_vertex>
          if (morphBase >= 0) transformed = texelFetch(morphPlaces, morphAt(), 0).xyz;`);
    };
  }

  forget(name) {
    this.bases.delete(name);
  }

  // Whether the browser can draw into textures of real numbers.
  static can(renderer) {
    return renderer.capabilities.maxTextureSize >= LONG
      && renderer.extensions.has("EXT_color_buffer_float");
  }

  load(head, data, offset, book) {
    this.drop();
    let count = 0, total = 0;
    for (const { name, entries } of head.meshes) {
      const entry = book.byName.get(name);
      if (!entry) return false;
      this.first.set(name, count);
      count += entry.rest.length / 3;
      total += entries;
    }
    const lists = new Lists(count, total), ring = new Lists(count, this.corners(head, book));
    const rest = new Float32Array(4 * WIDTH * rows(count, WIDTH));
    for (const { name, entries } of head.meshes) {
      const entry = book.byName.get(name), own = entry.rest.length / 3, first = this.first.get(name);
      const starts = new Uint32Array(data.slice(offset, offset + 4 * (own + 1)));
      offset += 4 * (own + 1);
      lists.add(starts, new Int16Array(data.slice(offset, offset + 8 * entries)));
      offset += 8 * entries;
      ring.around(entry.mesh.geometry.index.array, own, first);
      for (let i = 0; i < own; i++) {
        for (let c = 0; c < 3; c++) rest[4 * (first + i) + c] = entry.rest[3 * i + c];
      }
    }
    this.scales = head.scales;
    this.count = count;
    this.weights = new Float32Array(head.scales.length);
    this.build(rest, lists, ring);
    this.number = head.number;
    return true;
  }

  corners(head, book) {
    return head.meshes.reduce((sum, { name }) =>
      sum + book.byName.get(name).mesh.geometry.index.array.length, 0);
  }

  build(rest, lists, ring) {
    const target = () => new THREE.WebGLRenderTarget(WIDTH, rows(this.count, WIDTH), {
      type: THREE.FloatType, format: THREE.RGBAFormat, depthBuffer: false,
      minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
    });
    this.moved = target();
    this.turned = target();
    this.table = real(this.weights, this.weights.length, 1, THREE.RedFormat);
    this.textures = [
      this.table, real(rest, WIDTH, rows(this.count, WIDTH), THREE.RGBAFormat),
      lists.starts(), whole(lists.entries, 4, THREE.ShortType, "RGBA16I"),
      ring.starts(), whole(ring.entries, 2, THREE.IntType, "RG32I"),
    ];
    const [table, neutral, first, entries, corners, pairs] = this.textures;
    this.passes = [
      pass(MOVE, { places: neutral, weights: table, starts: first, entries }),
      pass(TURN, { places: this.moved.texture, weights: table, starts: corners, entries: pairs }),
    ];
    this.places.value = this.moved.texture;
    this.normals.value = this.turned.texture;
  }

  // Show the weights (one for each target) from now on.
  apply(weights, renderer) {
    for (let t = 0; t < this.weights.length; t++) this.weights[t] = weights[t] * this.scales[t];
    this.table.needsUpdate = true;
    [this.moved, this.turned].forEach((target, k) => {
      renderer.setRenderTarget(target);
      renderer.render(this.passes[k], CAMERA);
    });
    renderer.setRenderTarget(null);
    if (this.active) return;
    this.active = true;
    for (const [name, base] of this.bases) base.value = this.first.get(name) ?? -1;
  }

  rest() {
    this.active = false;
    for (const base of this.bases.values()) base.value = -1;
  }

  // Where the vertices of a mesh are shown: three numbers each.
  read(name, count, renderer) {
    const height = rows(this.count, WIDTH), all = new Float32Array(4 * WIDTH * height);
    renderer.readRenderTargetPixels(this.moved, 0, 0, WIDTH, height, all);
    const first = this.first.get(name), result = new Float32Array(3 * count);
    for (let i = 0; i < count; i++) {
      for (let c = 0; c < 3; c++) result[3 * i + c] = all[4 * (first + i) + c];
    }
    return result;
  }

  drop() {
    this.rest();
    this.number = -1;
    this.first.clear();
    for (const each of [...(this.textures || []), this.moved, this.turned]) each?.dispose();
    for (const each of this.passes || []) {
      each.children[0].material.dispose();
      each.children[0].geometry.dispose();
    }
    this.textures = this.passes = this.moved = this.turned = null;
    this.places.value = this.normals.value = null;
  }
}

const CAMERA = new THREE.Camera();
const rows = (count, width) => Math.max(Math.ceil((count + 1) / width), 1);

// Lists of all vertices one behind the other.
class Lists {
  constructor(count, total) {
    this.first = new Uint32Array(WIDTH * rows(count + 1, WIDTH));
    this.total = total;
    this.vertices = this.filled = 0;
  }

  add(starts, entries) {
    this.entries ??= new Int16Array(4 * LONG * rows(this.total, LONG));
    this.entries.set(entries, 4 * this.filled);
    for (let i = 1; i < starts.length; i++) this.first[++this.vertices] = this.filled + starts[i];
    this.filled += entries.length / 4;
  }

  // The two other corners of every face around each vertex.
  around(faces, count, base) {
    this.entries ??= new Int32Array(2 * LONG * rows(this.total, LONG));
    const places = new Uint32Array(count + 1);
    for (const vertex of faces) places[vertex + 1] += 1;
    for (let i = 0; i < count; i++) places[i + 1] += places[i];
    for (let i = 1; i <= count; i++) this.first[++this.vertices] = this.filled + places[i];
    for (let k = 0; k < faces.length; k++) {
      const face = k - (k % 3), corner = k % 3;
      const at = 2 * (this.filled + places[faces[k]]++);
      this.entries[at] = base + faces[face + ((corner + 1) % 3)];
      this.entries[at + 1] = base + faces[face + ((corner + 2) % 3)];
    }
    this.filled += faces.length;
  }

  starts() {
    const texture = new THREE.DataTexture(
      this.first, WIDTH, this.first.length / WIDTH, THREE.RedIntegerFormat, THREE.UnsignedIntType,
    );
    texture.internalFormat = "R32UI";
    texture.needsUpdate = true;
    return texture;
  }
}

function real(data, width, height, format) {
  const texture = new THREE.DataTexture(data, width, height, format, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function whole(data, channels, type, internal) {
  const format = channels === 4 ? THREE.RGBAIntegerFormat : THREE.RGIntegerFormat;
  const height = data.length / channels / LONG;
  const texture = new THREE.DataTexture(data, LONG, height, format, type);
  texture.internalFormat = internal;
  texture.needsUpdate = true;
  return texture;
}

function pass(fragment, uniforms) {
  const material = new THREE.RawShaderMaterial({
    glslVersion: THREE.GLSL3, vertexShader: FULL, fragmentShader: fragment, depthTest: false,
    depthWrite: false, blending: THREE.NoBlending,
    uniforms: Object.fromEntries(Object.entries(uniforms).map(([k, value]) => [k, { value }])),
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(9), 3));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  const scene = new THREE.Scene();
  scene.add(mesh);
  return scene;
}
