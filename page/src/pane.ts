// The layers of one run at one moment.

import { type Layer } from "@deck.gl/core";
import { LineLayer, ScatterplotLayer } from "@deck.gl/layers";
import type { Drawing } from "./drawing";
import { type FrameState, type Ghost, linkFactor } from "./stream";
import { type Rgba, signalColour, type Theme } from "./theme";
import type { Moment, Track } from "./track";
import { VehicleLayer } from "./vehicle_layer";

export interface Shown {
  links: [boolean, boolean, boolean];
  ghosts: boolean;
  leases: boolean;
}

const steps = 256;
/** Farther than this between two frames, a vehicle was moved and did not drive. */
const longestJump_m = 60;
/** Marks stay on the map this long, s. */
const markLasts_s = 3;

export class Pane {
  private places = new Float32Array(0);
  private bodies = new Float32Array(0);
  private colours = new Uint8Array(0);
  private rows = 0;
  private ghosts = new Map<number, Ghost>();

  constructor(
    readonly index: number,
    readonly track: Track,
    private readonly drawing: Drawing,
  ) {}

  /** Place (m) and heading of a vehicle, or nothing. Call after `layers`. */
  placeOf(slot: number, moment: Moment): [number, number] | undefined {
    const row = moment.now.rowOf(slot);
    return row < 0 || row >= this.rows ? undefined : [this.places[3 * row] as number, this.places[3 * row + 1] as number];
  }

  layers(moment: Moment, shown: Shown, theme: Theme, metresPerPixel: number): Layer[] {
    this.place(moment);
    this.paint(moment.now, theme);
    this.ghosts = new Map(moment.now.ghosts.map((ghost) => [ghost.slot, ghost]));
    const layers: Layer[] = [this.signalLayer(moment.now, theme, metresPerPixel)];
    for (const kind of [0, 1, 2] as const) {
      if (shown.links[kind]) layers.push(this.linkLayer(kind, moment, theme));
    }
    if (shown.ghosts) layers.push(...this.ghostLayers(moment, theme));
    layers.push(this.vehicleLayer(metresPerPixel));
    if (shown.leases) layers.push(...this.leaseLayers(moment, theme));
    layers.push(this.alarmLayer(moment, theme));
    return layers;
  }

  private id(name: string): string {
    return `${this.index}:${name}`;
  }

  /** Places between the two frames of the moment. */
  private place({ now, next, share }: Moment): void {
    this.grow(now.count);
    const { quantum_m } = this.drawing;
    let other = 0;
    for (let row = 0; row < now.count; ++row) {
      const slot = now.slot[row] as number;
      while (other < next.count && (next.slot[other] as number) < slot) ++other;
      const stays = share > 0 && other < next.count && next.slot[other] === slot;
      const x = now.x[row] as number;
      const y = now.y[row] as number;
      const dx = stays ? (next.x[other] as number) - x : 0;
      const dy = stays ? (next.y[other] as number) - y : 0;
      const drives = Math.hypot(dx, dy) * quantum_m < longestJump_m;
      const heading = now.heading[row] as number;
      const turn = stays ? ((((next.heading[other] as number) - heading + 384) & 255) - 128) * share : 0;
      this.places[3 * row] = (x + (drives ? dx * share : 0)) * quantum_m;
      this.places[3 * row + 1] = (y + (drives ? dy * share : 0)) * quantum_m;
      this.places[3 * row + 2] = ((heading + turn) * 2 * Math.PI) / steps;
    }
    this.rows = now.count;
  }

  private grow(rows: number): void {
    if (this.places.length >= 3 * rows) return;
    const room = Math.ceil(rows * 1.5);
    this.places = new Float32Array(3 * room);
    this.bodies = new Float32Array(3 * room);
    this.colours = new Uint8Array(4 * room);
  }

  private paint(now: FrameState, theme: Theme): void {
    for (let row = 0; row < now.count; ++row) {
      const vehicle = this.track.names.vehicles[now.slot[row] as number];
      const vehicleClass = vehicle?.vehicleClass ?? 0;
      const colour = theme.vehicles[vehicleClass as 0 | 1 | 2];
      this.bodies[3 * row] = vehicle?.length_m ?? 5;
      this.bodies[3 * row + 1] = vehicle?.width_m ?? 1.8;
      this.bodies[3 * row + 2] = vehicleClass + (now.dark[row] === 1 ? 4 : 0);
      this.colours.set(colour, 4 * row);
    }
  }

  private vehicleLayer(metresPerPixel: number): Layer {
    return new VehicleLayer({
      id: this.id("vehicles"),
      data: {
        length: this.rows,
        attributes: {
          instancePlaces: { value: this.places, size: 3 },
          instanceBodies: { value: this.bodies, size: 3 },
          instanceColours: { value: this.colours, size: 4, normalized: true },
        },
      },
      least_m: [7 * metresPerPixel, 4 * metresPerPixel],
    });
  }

  private signalLayer(now: FrameState, theme: Theme, metresPerPixel: number): Layer {
    return new LineLayer({
      id: this.id("signals"),
      data: this.drawing.signals.flatMap((signal) => signal.stopLines),
      getSourcePosition: (line) => line.from,
      getTargetPosition: (line) => line.to,
      getColor: (line) => signalColour(now.signals[line.signal]?.[line.link], theme),
      getWidth: Math.max(0.8, 2.5 * metresPerPixel),
      widthUnits: "common",
      updateTriggers: { getColor: [now.signals.join(","), theme] },
      dataComparator: () => true,
    });
  }

  private linkLayer(kind: 0 | 1 | 2, moment: Moment, theme: Theme): Layer {
    const from: number[] = [];
    const to: number[] = [];
    for (const link of moment.now.links[kind]) {
      const one = this.endOf(Math.floor(link / linkFactor), kind, moment);
      const other = this.endOf(link % linkFactor, kind, moment);
      if (one === undefined || other === undefined) continue;
      from.push(one[0], one[1], 0);
      to.push(other[0], other[1], 0);
    }
    return new LineLayer({
      id: this.id(`links-${kind}`),
      data: {
        length: from.length / 3,
        attributes: {
          getSourcePosition: { value: new Float32Array(from), size: 3 },
          getTargetPosition: { value: new Float32Array(to), size: 3 },
        },
      },
      getColor: theme.links[kind],
      getWidth: [3, 1.5, 1.5][kind] as number,
      widthUnits: "pixels",
    });
  }

  /** A believed link ends where its vehicle is believed to be. */
  private endOf(slot: number, kind: number, moment: Moment): [number, number] | undefined {
    const ghost = kind === 2 ? this.ghosts.get(slot) : undefined;
    if (ghost !== undefined) return [ghost.x * this.drawing.quantum_m, ghost.y * this.drawing.quantum_m];
    return this.placeOf(slot, moment);
  }

  private ghostLayers(moment: Moment, theme: Theme): Layer[] {
    const { quantum_m } = this.drawing;
    const ghosts = moment.now.ghosts.map((ghost) => ({
      at: [ghost.x * quantum_m, ghost.y * quantum_m] as [number, number],
      sigma_m: ghost.sigma_m,
      truth: this.placeOf(ghost.slot, moment),
    }));
    return [
      new ScatterplotLayer({
        id: this.id("sigma"),
        data: ghosts,
        getPosition: (ghost) => ghost.at,
        getRadius: (ghost) => Math.max(1.5, ghost.sigma_m),
        radiusUnits: "common",
        radiusMinPixels: 3,
        stroked: true,
        getFillColor: theme.sigma,
        getLineColor: theme.ghost,
        lineWidthUnits: "pixels",
        getLineWidth: 1.5,
      }),
      new LineLayer({
        id: this.id("ghost-error"),
        data: ghosts.filter((ghost) => ghost.truth !== undefined),
        getSourcePosition: (ghost) => ghost.at,
        getTargetPosition: (ghost) => ghost.truth as [number, number],
        getColor: theme.ghost,
        getWidth: 1,
        widthUnits: "pixels",
      }),
    ];
  }

  private leaseLayers(moment: Moment, theme: Theme): Layer[] {
    const rings: { at: [number, number]; radius_m: number }[] = [];
    for (const lease of moment.now.leases) {
      if (!lease.onSignal) {
        const at = this.placeOf(lease.target, moment);
        if (at !== undefined) rings.push({ at, radius_m: 4 });
        continue;
      }
      const ring = this.ringAround(lease.target);
      if (ring !== undefined) rings.push(ring);
    }
    return [this.rings("leases", rings, theme.lease)];
  }

  private ringAround(signal: number): { at: [number, number]; radius_m: number } | undefined {
    const lines = this.drawing.signals[signal]?.stopLines ?? [];
    if (lines.length === 0) return undefined;
    const xs = lines.map((line) => line.middle[0]);
    const ys = lines.map((line) => line.middle[1]);
    const at: [number, number] = [
      (Math.min(...xs) + Math.max(...xs)) / 2,
      (Math.min(...ys) + Math.max(...ys)) / 2,
    ];
    const radius_m = 4 + Math.max(...lines.map((line) => Math.hypot(line.middle[0] - at[0], line.middle[1] - at[1])));
    return { at, radius_m };
  }

  private alarmLayer(moment: Moment, theme: Theme): Layer {
    const { time_s } = moment.now;
    const rings: { at: [number, number]; radius_m: number }[] = [];
    for (const mark of this.track.marks) {
      if (mark.kind !== "braking" && mark.kind !== "collision") continue;
      if (mark.time_s > time_s || mark.time_s < time_s - markLasts_s) continue;
      const at = this.placeOf(mark.vehicle, moment);
      if (at !== undefined) rings.push({ at, radius_m: mark.kind === "collision" ? 10 : 6 });
    }
    return this.rings("alarms", rings, theme.alarm);
  }

  private rings(name: string, data: { at: [number, number]; radius_m: number }[], colour: Rgba): Layer {
    return new ScatterplotLayer({
      id: this.id(name),
      data,
      getPosition: (ring) => ring.at,
      getRadius: (ring) => ring.radius_m,
      radiusUnits: "common",
      radiusMinPixels: 7,
      filled: false,
      stroked: true,
      getLineColor: colour,
      lineWidthUnits: "pixels",
      getLineWidth: 2.5,
    });
  }
}
