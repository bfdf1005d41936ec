// The roads as meshes, made once, of which those in view are drawn. deck.gl's layer of paths computes the joins of every
// segment at every frame; without a GPU that takes a hundred times as long.

import { type DefaultProps, Layer, type LayerProps, project32 } from "@deck.gl/core";
import { Geometry, Model } from "@luma.gl/engine";
import type { DrawnLane, LaneKind } from "./drawing";
import type { Rgba, Theme } from "./theme";

const uniforms = `\
layout(std140) uniform lanesUniforms {
  vec4 colour;
  float least_m;
} lanes;
`;
const lanesUniforms = {
  name: "lanes",
  vs: uniforms,
  fs: uniforms,
  uniformTypes: { colour: "vec4<f32>", least_m: "f32" },
} as const;

const vertexShader = `\
#version 300 es
#define SHADER_NAME clearway-road-vertex
in vec2 places;
in vec2 asides;
in float halves;
void main(void) {
  vec3 place = vec3(places + asides * max(halves, lanes.least_m), 0.0);
  geometry.worldPosition = place;
  gl_Position = project_position_to_clipspace(place, vec3(0.0), vec3(0.0), geometry.position);
}
`;

const fragmentShader = `\
#version 300 es
#define SHADER_NAME clearway-road-fragment
precision highp float;
out vec4 fragColor;
void main(void) {
  fragColor = lanes.colour;
}
`;

/** In the order in which they are drawn. */
const kinds = ["walk", "junction", "road"] as const satisfies readonly LaneKind[];
/** Of the lane's width; the rest separates it from its neighbour. */
const drawnShare = 0.94;
/** Corners become no longer than this many half widths. */
const longestMitre = 2;
/** The network is divided into squares that are drawn or left out as a whole: so many a side, none smaller than this. */
const tilesAcross = 16;
const leastTile_m = 250;
/** A map of fewer metres a pixel shows footways. */
const footwaysBelow_m = 1.5;

/** Triangles of the lanes of one kind in one square: a place, where to from it for each metre of half width, and that. */
interface Tile {
  kind: LaneKind;
  places: number[];
  asides: number[];
  halves: number[];
  indices: number[];
  /** Left, low, right, high, m. */
  bounds: [number, number, number, number];
}

/** The points of a lane without those that repeat the one before. */
function distinct(path: Float32Array): [number, number][] {
  const points: [number, number][] = [];
  for (let i = 0; i + 1 < path.length; i += 2) {
    const point: [number, number] = [path[i] as number, path[i + 1] as number];
    const last = points.at(-1);
    if (last === undefined || last[0] !== point[0] || last[1] !== point[1]) points.push(point);
  }
  return points;
}

/** To the left of the way from one point to the other, of length 1. */
function normal([x, y]: [number, number], [toX, toY]: [number, number]): [number, number] {
  const length = Math.hypot(toX - x, toY - y);
  return [(y - toY) / length, (toX - x) / length];
}

/** To the left at a corner, so that both sides keep their width. */
function mitre(before: [number, number], after: [number, number]): [number, number] {
  const [x, y] = [before[0] + after[0], before[1] + after[1]];
  const length = Math.hypot(x, y);
  if (length < 1e-6) return after;
  // 1 / cosine of half the turn.
  const reach = Math.min(length / (x * after[0] + y * after[1]), longestMitre);
  return [(x / length) * reach, (y / length) * reach];
}

function addLane(lane: DrawnLane, points: [number, number][], tile: Tile): void {
  const normals = points.slice(1).map((point, i) => normal(points[i] as [number, number], point));
  const half_m = (lane.width_m * drawnShare) / 2;
  const { places, asides, halves, indices, bounds } = tile;
  const first = halves.length;
  points.forEach(([x, y], i) => {
    const before = normals[Math.max(0, i - 1)] as [number, number];
    const [aside_x, aside_y] = mitre(before, (normals[i] ?? before) as [number, number]);
    places.push(x, y, x, y);
    asides.push(aside_x, aside_y, -aside_x, -aside_y);
    halves.push(half_m, half_m);
    const at = first + 2 * i;
    if (i > 0) indices.push(at - 2, at - 1, at, at, at - 1, at + 1);
    const reach_m = longestMitre * half_m;
    bounds[0] = Math.min(bounds[0], x - reach_m);
    bounds[1] = Math.min(bounds[1], y - reach_m);
    bounds[2] = Math.max(bounds[2], x + reach_m);
    bounds[3] = Math.max(bounds[3], y + reach_m);
  });
}

function tilesOf(lanes: DrawnLane[]): Tile[] {
  // Places begin at the lower left corner of the network.
  const size_m = lanes.reduce((most, lane) => lane.path.reduce((one, other) => Math.max(one, other), most), 0);
  const tile_m = Math.max(leastTile_m, size_m / tilesAcross);
  const tiles = new Map<string, Tile>();
  for (const lane of lanes) {
    const points = distinct(lane.path);
    if (points.length < 2) continue;
    const [x, y] = points[points.length >> 1] as [number, number];
    const square = `${lane.kind} ${Math.floor(x / tile_m)} ${Math.floor(y / tile_m)}`;
    const tile = tiles.get(square) ?? {
      kind: lane.kind, places: [], asides: [], halves: [], indices: [], bounds: [Infinity, Infinity, -Infinity, -Infinity],
    };
    tiles.set(square, tile);
    addLane(lane, points, tile);
  }
  return [...tiles.values()].sort((one, other) => kinds.indexOf(one.kind) - kinds.indexOf(other.kind));
}

interface RoadProps {
  lanes: DrawnLane[];
  colours: Theme["lanes"];
  metresPerPixel: number;
}

/** A type and not an interface, because deck.gl's own state has an index signature. */
type RoadState = {
  tiles: Tile[];
  /** One for each tile. */
  models: Model[];
};

export class RoadLayer extends Layer<RoadProps & LayerProps> {
  static override layerName = "RoadLayer";
  static override defaultProps: DefaultProps<RoadProps> = {
    lanes: { type: "object", value: [] },
    colours: { type: "object", value: {} },
    metresPerPixel: { type: "number", value: 1 },
  } as unknown as DefaultProps<RoadProps>;
  declare state: RoadState;

  override getShaders() {
    return super.getShaders({ vs: vertexShader, fs: fragmentShader, modules: [project32, lanesUniforms] });
  }

  override initializeState(): void {
    const tiles = tilesOf(this.props.lanes);
    this.setState({ tiles, models: tiles.map((tile, i) => this.modelOf(tile, i)) });
  }

  override draw(): void {
    const { colours, metresPerPixel } = this.props;
    const [left, low, right, high] = this.context.viewport.getBounds();
    this.state.tiles.forEach(({ kind, bounds }, i) => {
      if (bounds[0] > right || bounds[2] < left || bounds[1] > high || bounds[3] < low) return;
      if (kind === "walk" && metresPerPixel > footwaysBelow_m) return;
      const model = this.state.models[i] as Model;
      // No lane is narrower on the screen than a pixel.
      const colour = colours[kind].map((part) => part / 255) as Rgba;
      model.shaderInputs.setProps({ lanes: { colour, least_m: metresPerPixel / 2 } });
      model.draw(this.context.renderPass);
    });
  }

  private modelOf({ places, asides, halves, indices }: Tile, number: number): Model {
    return new Model(this.context.device, {
      ...this.getShaders(),
      id: `${this.props.id}-${number}`,
      geometry: new Geometry({
        topology: "triangle-list",
        indices: new Uint32Array(indices),
        attributes: {
          places: { size: 2, value: new Float32Array(places) },
          asides: { size: 2, value: new Float32Array(asides) },
          halves: { size: 1, value: new Float32Array(halves) },
        },
      }),
    });
  }
}
