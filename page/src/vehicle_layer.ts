// Vehicles as instanced rectangles whose shape says their class: deck.gl has no layer of rotated boxes.

import { Layer, type LayerProps, project32, type UpdateParameters, type DefaultProps } from "@deck.gl/core";
import { Geometry, Model } from "@luma.gl/engine";

/** Shapes by class: human drivers are boxes, automated ones pointed at both ends, emergency vehicles arrows. */
const uniforms = `\
layout(std140) uniform vehicleUniforms {
  vec2 least_m;
} vehicle;
`;
const vehicleUniforms = {
  name: "vehicle",
  vs: uniforms,
  fs: uniforms,
  uniformTypes: { least_m: "vec2<f32>" },
} as const;

const vertexShader = `\
#version 300 es
#define SHADER_NAME clearway-vehicle-vertex
in vec3 positions;
in vec3 instancePlaces;
in vec3 instanceBodies;
in vec4 instanceColours;
out vec2 vBody;
out vec2 vSize;
out vec4 vColour;
flat out int vShape;
void main(void) {
  int shape = int(instanceBodies.z + 0.5);
  float grown = (shape & 3) == 2 ? 1.35 : 1.0;
  vec2 size = max(instanceBodies.xy, vehicle.least_m * grown);
  vec2 local = vec2((positions.x * 0.5 - 0.5) * size.x, positions.y * 0.5 * size.y);
  float c = cos(instancePlaces.z);
  float s = sin(instancePlaces.z);
  vec3 place = vec3(instancePlaces.xy + vec2(c * local.x - s * local.y, s * local.x + c * local.y), 0.0);
  geometry.worldPosition = place;
  gl_Position = project_position_to_clipspace(place, vec3(0.0), vec3(0.0), geometry.position);
  vBody = positions.xy;
  vSize = size;
  vColour = vec4(instanceColours.rgb, instanceColours.a * layer.opacity);
  vShape = shape;
}
`;

const fragmentShader = `\
#version 300 es
#define SHADER_NAME clearway-vehicle-fragment
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

/** Rows of a vehicle layer: x, y, heading (rad); length, width, shape (+ 4: hollow); colour. */
export interface VehicleColumns {
  length: number;
  attributes: {
    instancePlaces: { value: Float32Array; size: 3 };
    instanceBodies: { value: Float32Array; size: 3 };
    instanceColours: { value: Uint8Array; size: 4; normalized: true };
  };
}

interface VehicleProps {
  data: VehicleColumns;
  /** Length and width below which no vehicle is drawn, m, so that it stays visible from afar. */
  least_m: [number, number];
}

export class VehicleLayer extends Layer<VehicleProps & LayerProps> {
  static override layerName = "VehicleLayer";
  static override defaultProps: DefaultProps<VehicleProps> = {
    least_m: { type: "array", value: [0, 0] },
  } as unknown as DefaultProps<VehicleProps>;
  declare state: { model?: Model };

  override getShaders() {
    return super.getShaders({ vs: vertexShader, fs: fragmentShader, modules: [project32, vehicleUniforms] });
  }

  override initializeState(): void {
    this.getAttributeManager()?.addInstanced({
      instancePlaces: { size: 3, type: "float32", noAlloc: true },
      instanceBodies: { size: 3, type: "float32", noAlloc: true },
      instanceColours: { size: 4, type: "unorm8", noAlloc: true },
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
    if (model === undefined) return;
    model.shaderInputs.setProps({ vehicle: { least_m: this.props.least_m } });
    model.draw(this.context.renderPass);
  }

  private makeModel(): Model {
    const corners = new Float32Array([-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0]);
    return new Model(this.context.device, {
      ...this.getShaders(),
      id: this.props.id,
      bufferLayout: this.getAttributeManager()?.getBufferLayouts() ?? [],
      geometry: new Geometry({ topology: "triangle-strip", attributes: { positions: { size: 3, value: corners } } }),
      isInstanced: true,
    });
  }
}
