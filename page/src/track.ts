// One run that can be shown at any moment: recorded, or as far as it has happened.

import { AskedLog } from "./asked";
import { BlockKind, blocksOf, ByteReader, FrameState, type Mark, Names } from "./stream";
import { WayLog } from "./ways";

export interface About {
  run: string;
  scenario: string;
  condition: string;
  /** Of the condition; pages of older versions have none. */
  title?: string;
  replication: number;
  policies: string[];
  failure: string;
  predictor: string;
  incidents: Block[];
}

/** A road that is blocked for a while. */
export interface Block {
  edge: number;
  /** Numbers of the closed lanes. */
  lanes: number[];
  /** In the units of places. */
  place: [number, number];
  from_s: number;
  to_s: number;
}

/** Two frames and how far the moment lies between them. */
export interface Moment {
  now: FrameState;
  next: FrameState;
  /** 0: at `now`; 1: at `next`. */
  share: number;
}

/** A journey of an emergency vehicle, sampled at every frame. */
export interface Journey {
  time_s: number[];
  speed_mps: number[];
  distance_m: number[];
}

interface CodedFrame {
  time_s: number;
  kind: number;
  bytes: Uint8Array;
}

/** A live run forgets its oldest frames beyond this, bytes. */
const mostKept = 192e6;
const speedQuantum_mps = 0.1;

/** Decodes frames in either direction: from the key frame before, or from where it is. */
class Cursor {
  readonly state: FrameState;
  private index = -1;

  constructor(
    private readonly frames: CodedFrame[],
    quantum_m: number,
  ) {
    this.state = new FrameState(quantum_m);
  }

  seek(index: number): FrameState {
    if (index === this.index) return this.state;
    let from = index;
    while (from > 0 && from !== this.index + 1 && this.frame(from).kind !== BlockKind.key) --from;
    for (let i = from; i <= index; ++i) this.state.apply(this.frame(i).kind, new ByteReader(this.frame(i).bytes));
    this.index = index;
    return this.state;
  }

  /** The first `count` frames are gone. */
  forget(count: number): void {
    this.index = this.index < count ? -1 : this.index - count;
  }

  private frame(index: number): CodedFrame {
    return this.frames[index] as CodedFrame;
  }
}

export class Track {
  readonly names = new Names();
  readonly marks: Mark[] = [];
  /** Slots of the emergency vehicles, in the order of their departure. */
  readonly emergency: number[] = [];
  /** JSON texts of the stream, newest last: what a server says, how a run ended. */
  readonly messages: string[] = [];
  /** What was asked of vehicles and signals. */
  readonly asked = new AskedLog();
  /** Where emergency vehicles took another way. */
  readonly ways = new WayLog();
  private readonly frames: CodedFrame[] = [];
  private readonly journeys = new Map<number, Journey>();
  private readonly pass: FrameState;
  private readonly one: Cursor;
  private readonly other: Cursor;
  private kept = 0;

  constructor(
    readonly about: About,
    readonly quantum_m: number,
  ) {
    this.pass = new FrameState(quantum_m);
    this.one = new Cursor(this.frames, quantum_m);
    this.other = new Cursor(this.frames, quantum_m);
  }

  /** What readers call its condition. */
  get title(): string {
    return this.about.title ?? this.about.condition;
  }

  /** Takes the next blocks of the stream. Throws StreamError. */
  append(bytes: Uint8Array): void {
    for (const block of blocksOf(bytes)) {
      const content = bytes.subarray(block.begin, block.end);
      if (block.kind === BlockKind.names) this.names.add(new ByteReader(content), this.quantum_m);
      else if (block.kind === BlockKind.message) this.messages.push(new TextDecoder().decode(content));
      else this.addFrame(block.kind, content);
    }
  }

  get empty(): boolean {
    return this.frames.length === 0;
  }
  get begin_s(): number {
    return this.frames[0]?.time_s ?? 0;
  }
  get end_s(): number {
    return this.frames.at(-1)?.time_s ?? 0;
  }

  /** Before the first frame and after the last one those are shown. The track must not be empty. */
  at(time_s: number): Moment {
    const index = this.indexOf(time_s);
    const now = this.one.seek(index);
    if (index + 1 >= this.frames.length || time_s <= now.time_s + 1e-6) return { now, next: now, share: 0 };
    const next = this.other.seek(index + 1);
    return { now, next, share: Math.min(1, (time_s - now.time_s) / (next.time_s - now.time_s)) };
  }

  /** The time of the next frame in a direction. */
  beside(time_s: number, direction: -1 | 1): number {
    const index = this.indexOf(time_s);
    const here_s = this.time(index);
    if (direction < 0) return here_s < time_s - 1e-6 ? here_s : this.time(index - 1);
    return time_s < here_s - 1e-6 ? here_s : this.time(index + 1);
  }

  /** The roads that are blocked at a moment, known or not. */
  blocksAt(time_s: number): Block[] {
    return this.about.incidents.filter(({ from_s, to_s }) => from_s <= time_s + 1e-6 && time_s < to_s - 1e-6);
  }

  journey(slot: number): Journey {
    return this.journeys.get(slot) ?? { time_s: [], speed_mps: [], distance_m: [] };
  }

  private addFrame(kind: number, bytes: Uint8Array): void {
    this.pass.apply(kind, new ByteReader(bytes));
    this.frames.push({ time_s: this.pass.time_s, kind, bytes });
    this.marks.push(...this.pass.marks);
    this.asked.take(this.pass.time_s, this.pass.leases);
    for (const { slot, time_s } of this.ways.take(this.pass.time_s, this.pass.ways))
      this.marks.push({ kind: "way", time_s, vehicle: slot, other: -1 });
    this.follow();
    this.kept += bytes.length;
    if (this.kept > mostKept) this.forgetOldest();
  }

  private forgetOldest(): void {
    const half = this.frames.findIndex((frame, i) => i > this.frames.length / 4 && frame.kind === BlockKind.key);
    if (half <= 0) return;
    for (const frame of this.frames.splice(0, half)) this.kept -= frame.bytes.length;
    this.one.forget(half);
    this.other.forget(half);
  }

  private time(index: number): number {
    return (this.frames[Math.max(0, Math.min(this.frames.length - 1, index))] as CodedFrame).time_s;
  }

  private indexOf(time_s: number): number {
    let low = 0;
    let high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time(middle) <= time_s + 1e-6) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  private follow(): void {
    const { pass } = this;
    for (let row = 0; row < pass.count; ++row) {
      const slot = pass.slot[row] as number;
      if (this.names.vehicles[slot]?.vehicleClass !== 2) continue;
      let journey = this.journeys.get(slot);
      if (journey === undefined) {
        journey = { time_s: [], speed_mps: [], distance_m: [] };
        this.journeys.set(slot, journey);
        this.emergency.push(slot);
      }
      extend(journey, pass.time_s, (pass.speed[row] as number) * speedQuantum_mps);
    }
  }
}

/** Adds a moment; the way since the last one is driven at the mean of both speeds. */
function extend(journey: Journey, time_s: number, speed_mps: number): void {
  const last = journey.time_s.length - 1;
  const since_s = last < 0 ? 0 : time_s - (journey.time_s[last] as number);
  const driven_m = last < 0 ? 0 : (since_s * ((journey.speed_mps[last] as number) + speed_mps)) / 2;
  journey.time_s.push(time_s);
  journey.speed_mps.push(speed_mps);
  journey.distance_m.push((last < 0 ? 0 : (journey.distance_m[last] as number)) + driven_m);
}
