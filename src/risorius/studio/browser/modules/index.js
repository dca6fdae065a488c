// One viewport: meshes, views, pointer, overlay and the stream that feeds them.
import { Drops } from "./drops.js";
import { MeshBook } from "./meshes.js";
import { Overlay } from "./overlay.js";
import { Player } from "./player.js";
import { Pointer } from "./pointer.js";
import { Stream } from "./stream.js";
import { Views } from "./views.js";

export class Viewport {
  constructor(root, address, emit) {
    this.root = root;
    this.emit = emit;
    this.canvas = root.querySelector(".rv-canvas");
    this.dirty = true;
    this.settings = {
      opacity: { skin: 1, parts: 1, skull: 1, muscles: 1 },
      layout: "one",
      tool: "look",
      drawOn: [],
      hidden: [],
      selected: "",
      painted: false,
      drops: {},
    };
    this.stats = { drawn: 0, alone: 0, received: 0, bytes: 0, serial: 0, sceneCount: 0 };
    this.touch = () => { this.dirty = true; };
    this.meshes = new MeshBook(this.touch);
    this.views = new Views(this);
    this.overlay = new Overlay(this);
    this.pointer = new Pointer(this);
    this.player = new Player(this);
    this.stream = new Stream(address, this);
    this.drops = new Drops(this);
    this.closed = false;
    this.observer = new ResizeObserver(this.touch);
    this.observer.observe(root);
    const loop = (now) => {
      if (this.closed) return;
      requestAnimationFrame(loop);
      this.player.tick(now);
      if (this.dirty) {
        this.dirty = false;
        this.views.draw();
        this.overlay.place();
        this.stats.drawn += 1;
      }
      this.stream.acknowledge();
    };
    requestAnimationFrame(loop);
  }

  set(settings) {
    Object.assign(this.settings, settings);
    this.meshes.apply(this.settings);
    this.pointer.refresh();
    this.touch();
  }

  mark(marks) {
    this.views.marks = marks;
    this.touch();
  }

  picture(name) {
    this.views.draw();
    this.canvas.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = name;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 5000);
    }, "image/png");
  }

  // Vertices of a mesh as they are shown; for tests.
  shown(name) {
    return Array.from(this.meshes.shown(name, this.views.renderer));
  }

  // Page coordinates of a point in millimetres; for tests and for labels.
  locate(x, y, z) {
    const box = this.canvas.getBoundingClientRect();
    const at = this.views.project(x, y, z);
    return { x: box.left + at.x, y: box.top + at.y, front: at.front };
  }

  close() {
    this.closed = true;
    this.observer.disconnect();
    this.stream.close();
    this.drops.close();
    this.views.close();
  }
}
