// The network as the program describes it (view::drawing_of), in metres from its lower left corner.

export type LaneKind = "road" | "junction" | "walk";

export interface DrawnLane {
  kind: LaneKind;
  width_m: number;
  /** x, y, x, y, ... */
  path: Float32Array;
}

export interface StopLine {
  signal: number;
  link: number;
  from: [number, number];
  to: [number, number];
  middle: [number, number];
}

export interface Drawing {
  quantum_m: number;
  size_m: [number, number];
  lanes: DrawnLane[];
  /** By number of the edge: its first lane, and how many it has. */
  edges: [number, number][];
  signals: { id: string; stopLines: StopLine[] }[];
}

interface Described {
  quantum_m: number;
  size: [number, number];
  lanes: { kind: LaneKind; width: number; shape: number[] }[];
  edges: number[];
  signals: { id: string; links: [number, number, number, number][][] }[];
}

interface LaneEnd {
  line: [number, number, number, number];
  links: number[];
}

/** The links that begin at each lane: they share its stop line, from right to left by number. */
function laneEnds(links: [number, number, number, number][][]): LaneEnd[] {
  const ends = new Map<string, LaneEnd>();
  links.forEach((lines, link) => {
    for (const line of lines) {
      const end = ends.get(line.join()) ?? { line, links: [] };
      if (!end.links.includes(link)) end.links.push(link);
      ends.set(line.join(), end);
    }
  });
  return [...ends.values()];
}

function stopLines({ line, links }: LaneEnd, signal: number, quantum_m: number): StopLine[] {
  const [x, y, degrees, width] = line;
  const across = (degrees * Math.PI) / 180 + Math.PI / 2;
  const middle: [number, number] = [x * quantum_m, y * quantum_m];
  const at = (share: number): [number, number] => {
    const aside_m = (share - 0.5) * width * quantum_m;
    return [middle[0] + Math.cos(across) * aside_m, middle[1] + Math.sin(across) * aside_m];
  };
  return links.map((link, i) => ({ signal, link, from: at(i / links.length), to: at((i + 1) / links.length), middle }));
}

export function readDrawing(text: string): Drawing {
  const described = JSON.parse(text) as Described;
  const { quantum_m } = described;
  const lanes = described.lanes.map((lane) => {
    const path = new Float32Array(lane.shape.length);
    let x = 0;
    let y = 0;
    for (let i = 0; i + 1 < path.length; i += 2) {
      x += lane.shape[i] as number;
      y += lane.shape[i + 1] as number;
      path[i] = x * quantum_m;
      path[i + 1] = y * quantum_m;
    }
    return { kind: lane.kind, width_m: lane.width * quantum_m, path };
  });
  const signals = described.signals.map((signal, number) => ({
    id: signal.id,
    stopLines: laneEnds(signal.links).flatMap((end) => stopLines(end, number, quantum_m)),
  }));
  const edges: [number, number][] = [];
  for (let i = 0; i + 1 < described.edges.length; i += 2)
    edges.push([described.edges[i] as number, described.edges[i + 1] as number]);
  return { quantum_m, size_m: [described.size[0] * quantum_m, described.size[1] * quantum_m], lanes, edges, signals };
}
