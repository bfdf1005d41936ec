// Which part of the network is shown: a place, or where the followed vehicles are.

import { toggle } from "./controls";
import type { Camera } from "./map";
import type { Moment } from "./track";

const followZoom = 2.2;

export class View {
  readonly followLabel: HTMLElement;
  camera: Camera = { x: 0, y: 0, zoom: 0 };
  private readonly followBox: HTMLInputElement;
  private following = true;
  /** Whether a live run has shown no emergency vehicle yet: the view comes near when one enters. */
  private awaits = false;
  private readonly lastPlaces: ([number, number] | undefined)[] = [];

  /** `moved`: another part is to be shown. */
  constructor(
    private readonly quantum_m: number,
    private readonly moved: () => void,
  ) {
    this.followLabel = toggle("follow the emergency vehicle", true, (on) => this.setFollowing(on));
    this.followBox = this.followLabel.querySelector("input") as HTMLInputElement;
  }

  start(whole: Camera, isLive: boolean): void {
    this.camera = whole;
    this.awaits = isLive;
  }

  /** Shows a place; the view follows nobody any more. */
  look(camera: Camera): void {
    this.awaits = false;
    this.setFollowing(false);
    this.camera = camera;
    this.moved();
  }

  zoom(by: number): void {
    this.awaits = false;
    this.camera = { ...this.camera, zoom: Math.min(6, Math.max(-8, this.camera.zoom + by)) };
    this.moved();
  }

  setFollowing(on: boolean): void {
    this.following = on;
    this.followBox.checked = on;
    this.moved();
  }

  toggleFollowing(): void {
    this.setFollowing(!this.following);
  }

  comeNear(): void {
    this.awaits = false;
    this.camera = { ...this.camera, zoom: Math.max(this.camera.zoom, followZoom) };
  }

  /** An emergency vehicle may enter after the page was opened; who has chosen a view keeps it. */
  comeNearWho(slots: (number | undefined)[], moments: Moment[]): void {
    const enters = (slot: number | undefined, i: number) => slot !== undefined && (moments[i] as Moment).now.rowOf(slot) >= 0;
    if (this.awaits && this.following && slots.some(enters)) this.comeNear();
  }

  /** One for each run. */
  cameras(slots: (number | undefined)[], moments: Moment[]): Camera[] {
    return moments.map((moment, i) => {
      const at = this.following ? this.placeOf(slots[i], i, moment) : undefined;
      return at === undefined ? this.camera : { ...this.camera, x: at[0], y: at[1] };
    });
  }

  private placeOf(slot: number | undefined, i: number, { now, next, share }: Moment): [number, number] | undefined {
    if (slot === undefined) return undefined;
    const row = now.rowOf(slot);
    if (row < 0) return this.lastPlaces[i];
    const then = next.rowOf(slot);
    const x = now.x[row] as number;
    const y = now.y[row] as number;
    const to = then < 0 ? [x, y] : [next.x[then] as number, next.y[then] as number];
    this.lastPlaces[i] = [
      (x + ((to[0] as number) - x) * share) * this.quantum_m,
      (y + ((to[1] as number) - y) * share) * this.quantum_m,
    ];
    return this.lastPlaces[i];
  }
}
