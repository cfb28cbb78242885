// The page's one room: what is open in it, and what of it survives a scene, a recording or an error.
import { openRecording } from './recording/open.js';
import { sceneOf } from './scene.js';
import { ClipSource, RoomSource } from './sources.js';

const COLOR = 'color=960x540';

export class Room {
  constructor(relief, scenes, models) {
    this.relief = relief;
    this.scenes = scenes;
    this.models = models;
    this.clip = null;
    this.view = 'camera';
    this.orbit = { yaw: 0, pitch: 0, zoom: 1 };
    this.gravity = null; // null: as the scene has it
  }

  #address(name) {
    const address = this.scenes[name].source ?? 'synthetic:room';
    return `${address}${address.includes('?') ? '&' : '?'}${COLOR}`;
  }

  #make(name) {
    const scene = sceneOf(this.scenes[name], this.models);
    return this.clip ? new ClipSource(this.relief, this.clip, scene)
      : new RoomSource(this.relief, this.#address(name), scene);
  }

  /** A scene in the simulated room, or in the recording that is open. What cannot be opened leaves what was. */
  async openScene(name) {
    const source = this.#make(name);
    try {
      await source.open();
      this.source = source;
      this.name = name;
    } catch (error) {
      await this.source?.open();
      throw error;
    } finally {
      await this.#settle();
    }
    return source;
  }

  /** A recording, once its first frame is read; when that fails what was open stays. */
  async openFile(file, name, onProgress) {
    const clip = await openRecording(file, onProgress);
    const before = this.clip;
    await clip.frames[0].depth();
    this.clip = clip;
    try {
      return await this.openScene(name);
    } catch (error) {
      this.clip = before;
      throw error;
    }
  }

  leaveFile() { this.clip = null; }

  /** What a new room does not know yet. */
  async #settle() {
    await this.setView(this.view);
    await this.relief.call('setOrbit', this.orbit);
    if (this.gravity !== null) await this.setGravity(this.gravity);
  }

  setGravity(value) {
    this.gravity = value;
    return this.relief.call('setGravity', 0, value, 0);
  }

  setView(name) {
    this.view = name;
    return this.relief.do([['setView', name], ['setLegend', name !== 'camera']]);
  }

  get isElsewhere() { return this.view === 'points'; }

  turn(x, y, zoom) {
    const { orbit } = this;
    orbit.yaw -= x;
    orbit.pitch = Math.min(1.5, Math.max(-1.5, orbit.pitch + y));
    orbit.zoom = Math.min(10, Math.max(0.1, orbit.zoom * 0.9 ** zoom));
    return this.relief.call('setOrbit', orbit);
  }
}
