// The pointer: looks around, selects, places points on surfaces, drags handles, chooses faces.
const STILL = 5; // pixels that a click may wander
const PACE = 60; // milliseconds between two messages of a drag

export class Pointer {
  constructor(viewport) {
    this.viewport = viewport;
    this.down = null;
    this.dragged = null;
    this.sent = 0;
    const canvas = viewport.canvas;
    canvas.addEventListener("pointerdown", (e) => this.press(e), { capture: true });
    canvas.addEventListener("pointermove", (e) => this.move(e));
    canvas.addEventListener("pointerup", (e) => this.release(e));
    canvas.addEventListener("pointercancel", (e) => this.release(e));
    canvas.addEventListener("pointerleave", () => this.leave());
    canvas.addEventListener("dblclick", () => {
      if (this.drawing()) this.viewport.emit("finish", {});
    });
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
  }

  drawing() {
    return this.viewport.settings.tool === "draw";
  }

  refresh() {
    this.viewport.canvas.style.cursor = this.drawing() ? "crosshair" : "grab";
    if (!this.drawing()) this.viewport.overlay.point(null);
  }

  spot(e) {
    const box = this.viewport.canvas.getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  hit(x, y, groups) {
    const ray = this.viewport.views.ray(x, y);
    if (!ray) return null;
    const found = ray.caster.intersectObjects(
      this.viewport.meshes.targets(groups, ray.mode), false,
    )[0];
    if (!found) return null;
    return found;
  }

  // What the studio needs to find the place again on the mesh at rest.
  message(found) {
    const { a, b, c } = found.face, array = found.object.geometry.attributes.position;
    const corner = (k) => [array.getX(k), array.getY(k), array.getZ(k)];
    return {
      mesh: found.object.name, face: found.faceIndex,
      bary: barycentric(found.point.toArray(), corner(a), corner(b), corner(c)),
      at: found.point.toArray(),
    };
  }

  press(e) {
    if (e.button !== 0) return;
    const [x, y] = this.spot(e);
    this.down = [x, y];
    const nine = this.viewport.views.nine();
    const handle = nine ? null : this.viewport.overlay.nearest(x, y);
    if (handle && handle.on) {
      this.dragged = handle;
      this.viewport.views.orbit.enabled = false;
      this.viewport.canvas.setPointerCapture(e.pointerId);
      this.start = [...handle.at];
    }
  }

  move(e) {
    const [x, y] = this.spot(e);
    if (this.dragged) {
      this.drag(x, y, e.timeStamp);
      return;
    }
    if (e.buttons) return;
    if (this.viewport.views.nine()) return;
    const handle = this.viewport.overlay.nearest(x, y);
    this.viewport.canvas.style.cursor = handle ? "pointer" : this.drawing() ? "crosshair" : "grab";
    let tip = handle?.label || "";
    if (this.drawing()) {
      const found = handle ? null : this.hit(x, y, this.viewport.settings.drawOn);
      this.viewport.overlay.point(found ? found.point : null);
    } else if (!handle) {
      const found = this.hit(x, y, ["muscles", "skin", "parts", "skull"]);
      const name = found?.object.name;
      if (this.viewport.meshes.groupOf(name) === "muscles") tip = name.replaceAll("_", " ");
    }
    this.viewport.overlay.say(tip, x, y);
  }

  drag(x, y, time) {
    const found = this.hit(x, y, this.dragged.on);
    if (!found) return;
    this.viewport.overlay.moveHandle(this.dragged, found.point);
    this.last = { id: this.dragged.id, ...this.message(found) };
    if (time - this.sent > PACE) {
      this.sent = time;
      this.viewport.emit("dragging", this.last);
    }
  }

  release(e) {
    if (this.dragged) {
      const handle = this.dragged;
      this.dragged = null;
      this.viewport.views.orbit.enabled = true;
      if (this.last) this.viewport.emit("dropped", this.last);
      else this.viewport.emit("handle", { id: handle.id, shift: e.shiftKey, alt: e.altKey });
      this.last = null;
      this.down = null;
      return;
    }
    if (!this.down || e.button !== 0) return;
    const [x, y] = this.spot(e);
    const still = Math.hypot(x - this.down[0], y - this.down[1]) < STILL;
    this.down = null;
    if (still) this.click(x, y, e);
  }

  click(x, y, e) {
    const views = this.viewport.views;
    if (views.nine()) {
      const view = views.at(x, y);
      if (view) this.viewport.emit("choose", { index: view[4] });
      return;
    }
    if (this.drawing()) {
      if (e.detail > 1) return;
      const found = this.hit(x, y, this.viewport.settings.drawOn);
      if (found) {
        this.viewport.overlay.promise(found.point);
        this.viewport.emit("place", this.message(found));
      }
      return;
    }
    const found = this.hit(x, y, ["muscles", "skin", "parts", "skull"]);
    const through = this.hit(x, y, ["muscles"]);
    const clear = (this.viewport.settings.opacity.skin ?? 1) < 0.9;
    const chosen = clear && through ? through : found;
    if (chosen) this.viewport.emit("select", { ...this.message(chosen), shift: e.shiftKey });
    else this.viewport.emit("select", { mesh: "" });
  }

  leave() {
    this.viewport.overlay.say("", 0, 0);
    if (!this.dragged) this.viewport.overlay.point(null);
  }
}

function barycentric(p, a, b, c) {
  const sub = (u, v) => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const ab = sub(b, a), ac = sub(c, a), ap = sub(p, a);
  const d00 = dot(ab, ab), d01 = dot(ab, ac), d11 = dot(ac, ac);
  const d20 = dot(ap, ab), d21 = dot(ap, ac), base = d00 * d11 - d01 * d01;
  if (Math.abs(base) < 1e-20) return [1, 0, 0];
  const v = (d11 * d20 - d01 * d21) / base, w = (d00 * d21 - d01 * d20) / base;
  return [1 - v - w, v, w];
}
