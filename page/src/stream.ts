// Decodes the blocks of a stream: the other half of src/view/frame_encoder.cpp (docs/reference/frames.md).

/** The stream format that this page understands: view::stream_format. */
export const streamFormat = 2;

export const BlockKind = { names: 1, key: 2, delta: 3, message: 4 } as const;

/** Names of view::MarkKind, in its order. */
export const markNames = ["request", "grant", "braking", "collision", "departure", "arrival", "teleport"] as const;
/** `way`: an emergency vehicle took another way, which the page finds by itself. */
export type MarkName = (typeof markNames)[number] | "way";

export interface NamedVehicle {
  id: string;
  /** 0 human, 1 automated, 2 emergency. */
  vehicleClass: number;
  kind: number;
  length_m: number;
  width_m: number;
}

export interface Ghost {
  slot: number;
  x: number;
  y: number;
  sigma_m: number;
  age_s: number;
}

export interface Lease {
  onSignal: boolean;
  target: number;
  action: number;
  amount: number;
  policy: number;
  reason: number;
  /** Slot, or -1. */
  beneficiary: number;
}

/** The way of an emergency vehicle. */
export interface SeenWay {
  slot: number;
  /** Number of a way of Names. */
  way: number;
  /** Place in it of the last edge that was entered. */
  at: number;
}

export interface Mark {
  kind: MarkName;
  time_s: number;
  /** Slot, or -1. */
  vehicle: number;
  /** Slot or number of the signal, or -1. */
  other: number;
}

/** A stream that is damaged or of another format. */
export class StreamError extends Error {}

/** Reads the numbers of a stream; throws StreamError beyond the end. */
export class ByteReader {
  private at: number;
  constructor(
    private readonly bytes: Uint8Array,
    begin = 0,
    private readonly end = bytes.length,
  ) {
    if (begin > end || end > bytes.length) throw new StreamError("a block is cut short");
    this.at = begin;
  }
  get position(): number {
    return this.at;
  }
  get atEnd(): boolean {
    return this.at >= this.end;
  }
  byte(): number {
    if (this.at >= this.end) throw new StreamError("a block is cut short");
    return this.bytes[this.at++] as number;
  }
  number(): number {
    let value = 0;
    let scale = 1;
    for (;;) {
      const byte = this.byte();
      value += (byte & 0x7f) * scale;
      if (byte < 0x80) break;
      scale *= 0x80;
    }
    if (!Number.isSafeInteger(value)) throw new StreamError("a number is too large");
    return value;
  }
  signed(): number {
    const value = this.number();
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }
  text(): string {
    const length = this.number();
    const from = this.at;
    if (from + length > this.end) throw new StreamError("a text is cut short");
    this.at += length;
    return new TextDecoder().decode(this.bytes.subarray(from, this.at));
  }
}

export interface Block {
  kind: number;
  begin: number;
  end: number;
}

/** The blocks of `bytes`, without their content. */
export function* blocksOf(bytes: Uint8Array): Generator<Block> {
  let next = 0;
  while (next < bytes.length) {
    const head = new ByteReader(bytes, next);
    const kind = head.byte();
    const length = head.number();
    const begin = head.position;
    if (kind < 1 || kind > 4) throw new StreamError(`a block is of unknown kind ${kind}`);
    if (begin + length > bytes.length) throw new StreamError("the stream is cut short");
    yield { kind, begin, end: begin + length };
    next = begin + length;
  }
}

/** Names of vehicles, texts and ways, by number. */
export class Names {
  readonly vehicles: NamedVehicle[] = [];
  readonly texts: string[] = [];
  /** Numbers of their edges, in driving order. */
  readonly ways: number[][] = [];

  add(reader: ByteReader, quantum_m: number): void {
    for (let left = reader.number(); left > 0; --left) {
      const vehicleClass = reader.byte();
      const kind = reader.byte();
      const length_m = reader.number() * quantum_m;
      const width_m = reader.number() * quantum_m;
      this.vehicles.push({ id: reader.text(), vehicleClass, kind, length_m, width_m });
    }
    for (let left = reader.number(); left > 0; --left) this.texts.push(reader.text());
    for (let left = reader.number(); left > 0; --left) this.ways.push(readWay(reader));
  }
}

/** Links as one number each: lower slot times this, plus the higher. */
export const linkFactor = 0x4000000;

/** What the frames so far add up to. Vehicles ascend by slot; the first `count` of each column count. */
export class FrameState {
  time_s = Number.NaN;
  count = 0;
  slot = new Uint32Array(0);
  x = new Int32Array(0);
  y = new Int32Array(0);
  heading = new Uint8Array(0);
  speed = new Int32Array(0);
  dark = new Uint8Array(0);
  readonly signals: string[] = [];
  readonly links: [Set<number>, Set<number>, Set<number>] = [new Set(), new Set(), new Set()];
  ghosts: Ghost[] = [];
  leases: Lease[] = [];
  ways: SeenWay[] = [];
  /** Edges of incidents that last and are known. */
  knownBlocks: number[] = [];
  marks: Mark[] = [];
  /** Raised whenever signals, links, ghosts or leases change. */
  changes = 0;
  private moved_x = new Int32Array(0);
  private moved_y = new Int32Array(0);

  constructor(private readonly quantum_m: number) {}

  /** Takes a key frame or the difference from the frame before. */
  apply(kind: number, reader: ByteReader): void {
    if (kind === BlockKind.key) this.clear();
    else if (Number.isNaN(this.time_s)) throw new StreamError("a stream begins with a difference");
    this.time_s = reader.number() / 1000;
    this.readVehicles(reader);
    this.readSignals(reader);
    for (const links of this.links) this.readLinks(links, reader);
    this.readGhosts(reader);
    this.readLeases(reader);
    this.readWays(reader);
    this.readKnownBlocks(reader);
    this.readMarks(reader);
    if (!reader.atEnd) throw new StreamError("a frame is longer than its content");
  }

  /** Row of a vehicle, or -1. */
  rowOf(slot: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.slot[middle] as number) < slot) low = middle + 1;
      else high = middle;
    }
    return low < this.count && this.slot[low] === slot ? low : -1;
  }

  private clear(): void {
    this.count = 0;
    this.signals.length = 0;
    for (const links of this.links) links.clear();
    this.ghosts = [];
    this.leases = [];
    this.ways = [];
    this.knownBlocks = [];
    ++this.changes;
  }

  private readVehicles(reader: ByteReader): void {
    const gone = readAscending(reader);
    const added = readAscending(reader);
    this.merge(gone, added);
    const { count } = this;
    for (let i = 0; i < count; ++i) {
      this.moved_x[i] = (this.moved_x[i] as number) + reader.signed();
      this.x[i] = (this.x[i] as number) + (this.moved_x[i] as number);
    }
    for (let i = 0; i < count; ++i) {
      this.moved_y[i] = (this.moved_y[i] as number) + reader.signed();
      this.y[i] = (this.y[i] as number) + (this.moved_y[i] as number);
    }
    for (let i = 0; i < count; ++i) this.heading[i] = (this.heading[i] as number) + reader.signed();
    for (let i = 0; i < count; ++i) this.speed[i] = (this.speed[i] as number) + reader.signed();
    this.settleNew(added);
    for (const row of readAscending(reader)) {
      if (row >= count) throw new StreamError("a row is named that does not exist");
      this.dark[row] = 1 - (this.dark[row] as number);
    }
  }

  /** The first place of a vehicle is no motion. */
  private settleNew(added: number[]): void {
    for (const slot of added) {
      const row = this.rowOf(slot);
      this.moved_x[row] = 0;
      this.moved_y[row] = 0;
    }
  }

  private merge(gone: number[], added: number[]): void {
    if (gone.length === 0 && added.length === 0) return;
    const size = this.count - gone.length + added.length;
    if (size < 0) throw new StreamError("a vehicle leaves that was not there");
    const old = { ...this.columns() };
    const fresh = emptyColumns(size);
    let row = 0;
    let next = 0;
    let left = 0;
    for (let from = 0; from < this.count || next < added.length; ) {
      const slot = from < this.count ? (old.slot[from] as number) : Number.POSITIVE_INFINITY;
      if (next < added.length && (added[next] as number) < slot) {
        if (row < size) fresh.slot[row] = added[next] as number;
        ++row;
        ++next;
      } else if (left < gone.length && gone[left] === slot) {
        ++left;
        ++from;
      } else {
        if (row < size) copyRow(old, from, fresh, row);
        ++row;
        ++from;
      }
    }
    if (row !== size) throw new StreamError("a vehicle leaves that was not there");
    this.take(fresh, size);
  }

  private columns(): Columns {
    return {
      slot: this.slot, x: this.x, y: this.y, heading: this.heading, speed: this.speed, dark: this.dark,
      moved_x: this.moved_x, moved_y: this.moved_y,
    };
  }

  private take(columns: Columns, count: number): void {
    this.slot = columns.slot;
    this.x = columns.x;
    this.y = columns.y;
    this.heading = columns.heading;
    this.speed = columns.speed;
    this.dark = columns.dark;
    this.moved_x = columns.moved_x;
    this.moved_y = columns.moved_y;
    this.count = count;
  }

  private readSignals(reader: ByteReader): void {
    let signal = 0;
    for (let left = reader.number(); left > 0; --left) {
      signal += reader.number();
      this.signals[signal] = reader.text();
      ++this.changes;
    }
  }

  private readLinks(links: Set<number>, reader: ByteReader): void {
    for (const link of readLinks(reader)) {
      if (!links.delete(link)) throw new StreamError("a link ends that was not there");
      ++this.changes;
    }
    for (const link of readLinks(reader)) {
      links.add(link);
      ++this.changes;
    }
  }

  private readGhosts(reader: ByteReader): void {
    const count = reader.number();
    if (count === 0) return;
    ++this.changes;
    const ghosts: Ghost[] = [];
    let slot = 0;
    for (let left = count - 1; left > 0; --left) {
      slot += reader.number();
      const x = reader.signed();
      const y = reader.signed();
      ghosts.push({ slot, x, y, sigma_m: reader.number() * this.quantum_m, age_s: reader.number() / 10 });
    }
    this.ghosts = ghosts;
  }

  private readLeases(reader: ByteReader): void {
    const count = reader.number();
    if (count === 0) return;
    ++this.changes;
    const leases: Lease[] = [];
    for (let left = count - 1; left > 0; --left) {
      leases.push({
        onSignal: reader.byte() === 1,
        target: reader.number(),
        action: reader.byte(),
        amount: reader.signed(),
        policy: reader.number(),
        reason: reader.number(),
        beneficiary: reader.number() - 1,
      });
    }
    this.leases = leases;
  }

  private readWays(reader: ByteReader): void {
    const count = reader.number();
    if (count === 0) return;
    const ways: SeenWay[] = [];
    let slot = 0;
    for (let left = count - 1; left > 0; --left) {
      slot += reader.number();
      ways.push({ slot, way: reader.number(), at: reader.number() });
    }
    this.ways = ways;
  }

  private readKnownBlocks(reader: ByteReader): void {
    const count = reader.number();
    if (count === 0) return;
    const edges: number[] = [];
    let edge = 0;
    for (let left = count - 1; left > 0; --left) edges.push((edge += reader.number()));
    this.knownBlocks = edges;
  }

  private readMarks(reader: ByteReader): void {
    const marks: Mark[] = [];
    for (let left = reader.number(); left > 0; --left) {
      const kind = markNames[reader.byte()];
      if (kind === undefined) throw new StreamError("a mark is of unknown kind");
      const time_s = this.time_s - reader.number() / 1000;
      marks.push({ kind, time_s, vehicle: reader.number() - 1, other: reader.number() - 1 });
    }
    this.marks = marks;
  }
}

interface Columns {
  slot: Uint32Array<ArrayBuffer>;
  x: Int32Array<ArrayBuffer>;
  y: Int32Array<ArrayBuffer>;
  heading: Uint8Array<ArrayBuffer>;
  speed: Int32Array<ArrayBuffer>;
  dark: Uint8Array<ArrayBuffer>;
  moved_x: Int32Array<ArrayBuffer>;
  moved_y: Int32Array<ArrayBuffer>;
}

function emptyColumns(size: number): Columns {
  return {
    slot: new Uint32Array(size), x: new Int32Array(size), y: new Int32Array(size),
    heading: new Uint8Array(size), speed: new Int32Array(size), dark: new Uint8Array(size),
    moved_x: new Int32Array(size), moved_y: new Int32Array(size),
  };
}

function copyRow(from: Columns, row: number, to: Columns, at: number): void {
  to.slot[at] = from.slot[row] as number;
  to.x[at] = from.x[row] as number;
  to.y[at] = from.y[row] as number;
  to.heading[at] = from.heading[row] as number;
  to.speed[at] = from.speed[row] as number;
  to.dark[at] = from.dark[row] as number;
  to.moved_x[at] = from.moved_x[row] as number;
  to.moved_y[at] = from.moved_y[row] as number;
}

function readAscending(reader: ByteReader): number[] {
  const values: number[] = [];
  let value = 0;
  for (let left = reader.number(); left > 0; --left) {
    value += reader.number();
    values.push(value);
  }
  return values;
}

function readWay(reader: ByteReader): number[] {
  const edges: number[] = [];
  let edge = 0;
  for (let left = reader.number(); left > 0; --left) edges.push((edge += reader.signed()));
  return edges;
}

function readLinks(reader: ByteReader): number[] {
  const links: number[] = [];
  let one = 0;
  let other = 0;
  for (let left = reader.number(); left > 0; --left) {
    const step = reader.number();
    one += step;
    if (step !== 0) other = one;
    other += reader.number();
    links.push(one * linkFactor + other);
  }
  return links;
}
