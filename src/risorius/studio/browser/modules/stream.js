// The binary stream from the studio; formats as in frames.py. Every message is acknowledged once
// it has been drawn, so the server never has more than a few under way.
import { Morph } from "./morph.js";

const SCENE = 1, FRAME = 2, CANDIDATES = 3, TARGETS = 4, TAKE = 5;

export class Stream {
  constructor(address, viewport) {
    this.address = address;
    this.viewport = viewport;
    this.seen = 0;
    this.ended = false;
    this.epoch = -1;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}${this.address}`);
    this.socket.binaryType = "arraybuffer";
    this.seen = 0;
    this.socket.onmessage = (event) => this.take(event.data);
    this.socket.onopen = () => this.viewport.root.classList.remove("rv-offline");
    this.socket.onclose = () => {
      if (this.ended) return;
      this.viewport.root.classList.add("rv-offline");
      setTimeout(() => { if (!this.ended) this.open(); }, 700);
    };
  }

  close() {
    this.ended = true;
    this.socket.close();
  }

  acknowledge() {
    if (!this.seen || this.socket.readyState !== WebSocket.OPEN) return;
    this.socket.send(`ack ${this.seen}`);
    this.seen = 0;
  }

  take(data) {
    const view = new DataView(data);
    const kind = view.getUint32(0, true), epoch = view.getUint32(4, true);
    const serial = view.getUint32(8, true), length = view.getUint32(12, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 16, length)));
    const stats = this.viewport.stats, meshes = this.viewport.meshes;
    stats.received += 1;
    stats.bytes += data.byteLength;
    if (kind === SCENE) {
      this.epoch = epoch;
      meshes.replace(head, data, 16 + length);
      meshes.apply(this.viewport.settings);
      if (head.centre) this.viewport.views.frame(head);
      stats.sceneCount += 1;
    } else if (epoch === this.epoch) {
      if (kind === FRAME) {
        meshes.move(head, data, 16 + length);
        stats.serial = serial;
      } else if (kind === CANDIDATES) {
        meshes.bring(head, data, 16 + length);
      } else if (kind === TARGETS && Morph.can(this.viewport.views.renderer)) {
        meshes.morph.load(head, data, 16 + length, meshes);
      } else if (kind === TAKE) {
        this.viewport.player.bring(head, data, 16 + length);
      }
    }
    this.seen += 1;
    this.viewport.touch();
  }
}
