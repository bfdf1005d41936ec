// The layers of one run at one moment.

import { type Layer } from "@deck.gl/core";
import { ScatterplotLayer } from "@deck.gl/layers";
import type { Thing } from "./asked";
import { Boxes, BoxLayer, hollow } from "./box_layer";
import type { Drawing } from "./drawing";
import { type FrameState, type Ghost, linkFactor } from "./stream";
import { type Rgba, signalColour, type Theme } from "./theme";
import type { Moment, Track } from "./track";
import { consideredLines, consideredWay, formerLines, lineAhead, type Point } from "./ways";

export interface Shown {
  links: [boolean, boolean, boolean];
  ghosts: boolean;
  leases: boolean;
  ways: boolean;
  /** By pane: the emergency vehicle whose way is shown. */
  followed: (number | undefined)[];
  chosen?: Thing;
}

const steps = 256;
/** Farther than this between two frames, a vehicle was moved and did not drive. */
const longestJump_m = 60;
/** Marks stay on the map this long, s. */
const markLasts_s = 3;

function pointsOf(path: Float32Array): Point[] {
  const points: Point[] = [];
  for (let i = 0; i + 1 < path.length; i += 2) points.push([path[i] as number, path[i + 1] as number]);
  return points;
}

function lineOf(boxes: Boxes, line: Point[], width_m: number, colour: Rgba): void {
  for (let i = 0; i + 1 < line.length; ++i) boxes.line(line[i] as Point, line[i + 1] as Point, width_m, colour);
}

/** The same with gaps two thirds as long as the dashes. */
function dashesOf(boxes: Boxes, line: Point[], width_m: number, dash_m: number, colour: Rgba): void {
  const period_m = (5 * dash_m) / 3;
  let driven_m = 0;
  for (let i = 0; i + 1 < line.length; ++i) {
    const [from, to] = [line[i] as Point, line[i + 1] as Point];
    const piece_m = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const place = (along_m: number): Point => {
      const share = along_m / piece_m;
      return [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])];
    };
    for (let begin_m = -(driven_m % period_m); begin_m < piece_m; begin_m += period_m) {
      const [low_m, high_m] = [Math.max(0, begin_m), Math.min(piece_m, begin_m + dash_m)];
      if (low_m < high_m) boxes.line(place(low_m), place(high_m), width_m, colour);
    }
    driven_m += piece_m;
  }
}

export class Pane {
  private places = new Float32Array(0);
  private slots: Uint32Array = new Uint32Array(0);
  private rows = 0;
  private readonly boxes = new Map<string, Boxes>();
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
    this.ghosts = new Map(moment.now.ghosts.map((ghost) => [ghost.slot, ghost]));
    const isBlocked = this.track.blocksAt(moment.now.time_s).length > 0;
    const layers: Layer[] = isBlocked ? [this.closedLayer(moment.now, theme)] : [];
    if (shown.ways) layers.push(this.wayLayer(this.waysShown(shown), moment, theme, metresPerPixel));
    layers.push(this.signalLayer(moment.now, theme, metresPerPixel));
    for (const kind of [0, 1, 2] as const) {
      if (shown.links[kind]) layers.push(this.linkLayer(kind, moment, theme, metresPerPixel));
    }
    if (shown.ghosts) layers.push(...this.ghostLayers(moment, theme, metresPerPixel));
    layers.push(this.vehicleLayer(moment.now, theme, metresPerPixel));
    if (shown.leases) layers.push(...this.leaseLayers(moment, theme));
    layers.push(this.alarmLayer(moment, theme));
    if (isBlocked) layers.push(...this.blockSigns(moment.now, theme, metresPerPixel));
    if (shown.chosen?.pane === this.index) layers.push(this.chosenLayer(shown.chosen, moment, theme));
    return layers;
  }

  /** What lies nearest to a place (m) and not farther than `reach_m`: a vehicle, else a signal. */
  nearest(x: number, y: number, reach_m: number): Thing | undefined {
    const thing = (onSignal: boolean, number: number | undefined) =>
      number === undefined ? undefined : { pane: this.index, onSignal, number };
    let best: number | undefined;
    let best_m = reach_m;
    for (let row = 0; row < this.rows; ++row) {
      const away_m = Math.hypot((this.places[3 * row] as number) - x, (this.places[3 * row + 1] as number) - y);
      if (away_m > best_m) continue;
      best_m = away_m;
      best = this.slots[row];
    }
    if (best !== undefined) return thing(false, best);
    this.drawing.signals.forEach((signal, number) => {
      for (const { middle } of signal.stopLines) {
        const away_m = Math.hypot(middle[0] - x, middle[1] - y);
        if (away_m > best_m) continue;
        best_m = away_m;
        best = number;
      }
    });
    return thing(true, best);
  }

  private id(name: string): string {
    return `${this.index}:${name}`;
  }

  /** The empty list of the boxes of a layer. */
  private emptied(name: string): Boxes {
    const known = this.boxes.get(name) ?? new Boxes();
    this.boxes.set(name, known);
    known.clear();
    return known;
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
    this.slots = now.slot;
  }

  private grow(rows: number): void {
    if (this.places.length >= 3 * rows) return;
    this.places = new Float32Array(3 * Math.ceil(rows * 1.5));
  }

  private vehicleLayer(now: FrameState, theme: Theme, metresPerPixel: number): Layer {
    const boxes = this.emptied("vehicles");
    for (let row = 0; row < now.count; ++row) {
      const vehicle = this.track.names.vehicles[now.slot[row] as number];
      const vehicleClass = (vehicle?.vehicleClass ?? 0) as 0 | 1 | 2;
      // Visible from afar, too.
      const least = metresPerPixel * (vehicleClass === 2 ? 1.35 : 1);
      const length_m = Math.max(vehicle?.length_m ?? 5, 7 * least);
      const width_m = Math.max(vehicle?.width_m ?? 1.8, 4 * least);
      const heading = this.places[3 * row + 2] as number;
      const along: [number, number] = [Math.cos(heading), Math.sin(heading)];
      // A place is the middle of the front.
      const x = (this.places[3 * row] as number) - along[0] * length_m;
      const y = (this.places[3 * row + 1] as number) - along[1] * length_m;
      const shape = vehicleClass + (now.dark[row] === 1 ? hollow : 0);
      boxes.add(x, y, along, [length_m, width_m], shape, theme.vehicles[vehicleClass]);
    }
    return BoxLayer.of(this.id("vehicles"), boxes);
  }

  /** The lanes that are closed now. */
  private closedLayer(now: FrameState, theme: Theme): Layer {
    const boxes = this.emptied("closed");
    for (const { lanes } of this.track.blocksAt(now.time_s)) {
      for (const number of lanes) {
        const lane = this.drawing.lanes[number];
        if (lane !== undefined) lineOf(boxes, pointsOf(lane.path), lane.width_m, theme.closed);
      }
    }
    return BoxLayer.of(this.id("closed"), boxes);
  }

  /** No entry: full where the block is known, else a ring. */
  private blockSigns(now: FrameState, theme: Theme, metresPerPixel: number): Layer[] {
    const { quantum_m } = this.drawing;
    const least_px = 9;
    const radius_m = Math.max(3, least_px * metresPerPixel);
    const signs = this.track.blocksAt(now.time_s).map(({ edge, place }) => ({
      at: [place[0] * quantum_m, place[1] * quantum_m] as Point,
      isKnown: now.knownBlocks.includes(edge),
    }));
    const bars = this.emptied("block-bars");
    for (const { at: [x, y], isKnown } of signs) {
      const colour = isKnown ? theme.bar : theme.block;
      bars.line([x - 0.55 * radius_m, y], [x + 0.55 * radius_m, y], 0.4 * radius_m, colour);
    }
    const discs = new ScatterplotLayer({
      id: this.id("blocks"),
      data: signs,
      getPosition: (sign) => sign.at,
      getRadius: radius_m,
      radiusUnits: "common",
      getFillColor: (sign) => (sign.isKnown ? theme.block : theme.background),
      stroked: true,
      getLineColor: theme.block,
      lineWidthUnits: "pixels",
      getLineWidth: 2.5,
    });
    return [discs, BoxLayer.of(this.id("block-bars"), bars)];
  }

  private waysShown(shown: Shown): Set<number> {
    const slots = new Set<number>();
    const followed = shown.followed[this.index];
    if (followed !== undefined) slots.add(followed);
    if (shown.chosen?.pane === this.index && !shown.chosen.onSignal) slots.add(shown.chosen.number);
    return slots;
  }

  /** What lies ahead of emergency vehicles and, dashed, the way that one left a moment ago; dotted, ways considered. */
  private wayLayer(slots: Set<number>, moment: Moment, theme: Theme, metresPerPixel: number): Layer {
    const boxes = this.emptied("ways");
    const { now } = moment;
    const width_m = Math.max(1.4, 4 * metresPerPixel);
    for (const seen of now.ways) {
      const { slot, way, at } = seen;
      const place = slots.has(slot) ? this.placeOf(slot, moment) : undefined;
      const edges = this.track.names.ways[way];
      if (place === undefined || edges === undefined) continue;
      const change = this.track.ways.shown(slot, now.time_s);
      const former = change === undefined ? undefined : this.track.names.ways[change.before];
      if (change !== undefined && former !== undefined) {
        for (const line of formerLines(this.drawing, former, edges, change.at))
          dashesOf(boxes, line, width_m, Math.max(5, 9 * metresPerPixel), theme.way);
      }
      for (const line of consideredLines(this.drawing, now.leases, seen, this.track.names.ways))
        dashesOf(boxes, line, 0.5 * width_m, Math.max(2, 3 * metresPerPixel), theme.way);
      lineOf(boxes, lineAhead(this.drawing, edges, at, place), width_m, theme.way);
    }
    return BoxLayer.of(this.id("ways"), boxes);
  }

  private signalLayer(now: FrameState, theme: Theme, metresPerPixel: number): Layer {
    const boxes = this.emptied("signals");
    const width_m = Math.max(0.8, 2.5 * metresPerPixel);
    for (const signal of this.drawing.signals) {
      for (const line of signal.stopLines)
        boxes.line(line.from, line.to, width_m, signalColour(now.signals[line.signal]?.[line.link], theme));
    }
    return BoxLayer.of(this.id("signals"), boxes);
  }

  private linkLayer(kind: 0 | 1 | 2, moment: Moment, theme: Theme, metresPerPixel: number): Layer {
    const boxes = this.emptied(`links-${kind}`);
    const width_m = ([3, 2, 2][kind] as number) * metresPerPixel;
    for (const link of moment.now.links[kind]) {
      const one = this.endOf(Math.floor(link / linkFactor), kind, moment);
      const other = this.endOf(link % linkFactor, kind, moment);
      if (one !== undefined && other !== undefined) boxes.line(one, other, width_m, theme.links[kind]);
    }
    return BoxLayer.of(this.id(`links-${kind}`), boxes);
  }

  /** A believed link ends where its vehicle is believed to be. */
  private endOf(slot: number, kind: number, moment: Moment): [number, number] | undefined {
    const ghost = kind === 2 ? this.ghosts.get(slot) : undefined;
    if (ghost !== undefined) return [ghost.x * this.drawing.quantum_m, ghost.y * this.drawing.quantum_m];
    return this.placeOf(slot, moment);
  }

  private ghostLayers(moment: Moment, theme: Theme, metresPerPixel: number): Layer[] {
    const { quantum_m } = this.drawing;
    const ghosts = moment.now.ghosts.map((ghost) => ({
      at: [ghost.x * quantum_m, ghost.y * quantum_m] as [number, number],
      sigma_m: ghost.sigma_m,
      truth: this.placeOf(ghost.slot, moment),
    }));
    const errors = this.emptied("ghost-error");
    for (const { at, truth } of ghosts) {
      if (truth !== undefined) errors.line(at, truth, metresPerPixel, theme.ghost);
    }
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
      BoxLayer.of(this.id("ghost-error"), errors),
    ];
  }

  private leaseLayers(moment: Moment, theme: Theme): Layer[] {
    const rings: { at: [number, number]; radius_m: number }[] = [];
    for (const lease of moment.now.leases) {
      if (consideredWay(lease) !== undefined) continue;
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

  private chosenLayer(chosen: Thing, moment: Moment, theme: Theme): Layer {
    const at = chosen.onSignal ? undefined : this.placeOf(chosen.number, moment);
    const ring = chosen.onSignal ? this.ringAround(chosen.number) : at && { at, radius_m: 6 };
    return this.rings("chosen", ring === undefined ? [] : [{ ...ring, radius_m: ring.radius_m + 2 }], theme.chosen);
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
