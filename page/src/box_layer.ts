// Boxes of any heading: vehicles, whose shape says their class, and lines. Their corners are computed here and drawn as
// one mesh: a processor that draws without a GPU takes each instance of an instanced layer as a drawing of its own.

import { type DefaultProps, Layer, type LayerProps, project32, type UpdateParameters } from "@deck.gl/core";
import { Model } from "@luma.gl/engine";
import type { Rgba } from "./theme";

/** Shapes: human drivers and lines are boxes, automated vehicles pointed at both ends, emergency vehicles arrows. */
export const hollow = 4;

const vertexShader = `\
#version 300 es
#define SHADER_NAME clearway-box-vertex
in vec2 places;
in vec3 bodies;
in vec2 sizes;
in vec4 colours;
out vec2 vBody;
out vec2 vSize;
out vec4 vColour;
flat out int vShape;
void main(void) {
  vec3 place = vec3(places, 0.0);
  geometry.worldPosition = place;
  gl_Position = project_position_to_clipspace(place, vec3(0.0), vec3(0.0), geometry.position);
  vBody = bodies.xy;
  vSize = sizes;
  vColour = colours;
  vShape = int(bodies.z + 0.5);
}
`;

const fragmentShader = `\
#version 300 es
#define SHADER_NAME clearway-box-fragment
precision highp float;
in vec2 vBody;
in vec2 vSize;
in vec4 vColour;
flat in int vShape;
out vec4 fragColor;
void main(void) {
  int form = vShape & 3;
  bool hollow = (vShape & 4) != 0;
  float across = abs(vBody.y);
  float front = (1.0 - vBody.x) * 0.5 * vSize.x / vSize.y;
  float back = (1.0 + vBody.x) * 0.5 * vSize.x / vSize.y;
  float inside = 1.0 - across;
  if (form == 1) inside = min(inside, min(front, back) * 2.0 + 0.6 - across);
  if (form == 2) inside = min(inside, front * 1.2 + 0.05 - across);
  if (inside < 0.0) discard;
  float edge = min(min(inside, front * 2.0), back * 2.0);
  if (hollow && edge > 0.42) discard;
  vec3 colour = vColour.rgb;
  if (!hollow && form == 2 && edge < 0.16) colour = vec3(1.0);
  fragColor = vec4(colour, vColour.a);
}
`;

/** Corners of the two triangles of a box: along and across. */
const corners: readonly (readonly [number, number])[] = [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]];

/** Boxes to draw, in their order; kept from frame to frame. */
export class Boxes {
  length = 0;
  places = new Float32Array(0);
  bodies = new Float32Array(0);
  sizes = new Float32Array(0);
  colours = new Uint8Array(0);

  clear(): void {
    this.length = 0;
  }

  /** A box from the middle of its back, m; `along` is a direction of length 1. */
  add(x: number, y: number, along: [number, number], size_m: [number, number], shape: number, colour: Rgba): void {
    if (6 * (this.length + 1) > this.places.length / 2) this.grow();
    const [c, s] = along;
    let vertex = 6 * this.length++;
    for (const corner of corners) {
      const ahead = ((corner[0] + 1) / 2) * size_m[0];
      const left = (corner[1] / 2) * size_m[1];
      this.places[2 * vertex] = x + c * ahead - s * left;
      this.places[2 * vertex + 1] = y + s * ahead + c * left;
      this.bodies[3 * vertex] = corner[0];
      this.bodies[3 * vertex + 1] = corner[1];
      this.bodies[3 * vertex + 2] = shape;
      this.sizes[2 * vertex] = size_m[0];
      this.sizes[2 * vertex + 1] = size_m[1];
      this.colours.set(colour, 4 * vertex);
      ++vertex;
    }
  }

  /** A line of some width, m. */
  line(from: readonly [number, number], to: readonly [number, number], width_m: number, colour: Rgba): void {
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    const length_m = Math.hypot(dx, dy);
    if (length_m > 0) this.add(from[0], from[1], [dx / length_m, dy / length_m], [length_m, width_m], 0, colour);
  }

  private grow(): void {
    const room = 6 * Math.max(64, 2 * this.length);
    const grown = <Numbers extends Float32Array | Uint8Array>(into: Numbers, from: Numbers): Numbers => {
      into.set(from);
      return into;
    };
    this.places = grown(new Float32Array(2 * room), this.places);
    this.bodies = grown(new Float32Array(3 * room), this.bodies);
    this.sizes = grown(new Float32Array(2 * room), this.sizes);
    this.colours = grown(new Uint8Array(4 * room), this.colours);
  }
}

interface BoxProps {
  data: {
    length: number;
    attributes: Record<string, { value: Float32Array | Uint8Array; size: number; normalized?: boolean }>;
  };
}

export class BoxLayer extends Layer<BoxProps & LayerProps> {
  static override layerName = "BoxLayer";
  static override defaultProps: DefaultProps<BoxProps> = {};
  declare state: { model?: Model };

  static of(id: string, boxes: Boxes): BoxLayer {
    return new BoxLayer({
      id,
      data: {
        length: 6 * boxes.length,
        attributes: {
          places: { value: boxes.places, size: 2 },
          bodies: { value: boxes.bodies, size: 3 },
          sizes: { value: boxes.sizes, size: 2 },
          colours: { value: boxes.colours, size: 4, normalized: true },
        },
      },
    });
  }

  override getShaders() {
    return super.getShaders({ vs: vertexShader, fs: fragmentShader, modules: [project32] });
  }

  override initializeState(): void {
    this.getAttributeManager()?.add({
      places: { size: 2, type: "float32", noAlloc: true },
      bodies: { size: 3, type: "float32", noAlloc: true },
      sizes: { size: 2, type: "float32", noAlloc: true },
      colours: { size: 4, type: "unorm8", noAlloc: true },
    });
  }

  override updateState(parameters: UpdateParameters<this>): void {
    super.updateState(parameters);
    if (!parameters.changeFlags.extensionsChanged) return;
    this.state.model?.destroy();
    this.state.model = this.makeModel();
    this.getAttributeManager()?.invalidateAll();
  }

  override draw(): void {
    const { model } = this.state;
    const { length } = this.props.data;
    if (model === undefined || length === 0) return;
    model.setVertexCount(length);
    model.draw(this.context.renderPass);
  }

  private makeModel(): Model {
    return new Model(this.context.device, {
      ...this.getShaders(),
      id: this.props.id,
      bufferLayout: this.getAttributeManager()?.getBufferLayouts() ?? [],
      topology: "triangle-list",
    });
  }
}
