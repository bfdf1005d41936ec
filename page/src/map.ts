// Draws one or two panes into one canvas with deck.gl.

import { Deck, type Layer, OrthographicView, type OrthographicViewState } from "@deck.gl/core";
import type { Thing } from "./asked";
import type { Drawing } from "./drawing";
import type { Pane, Shown } from "./pane";
import { RoadLayer } from "./road_layer";
import { dark, light, type Theme } from "./theme";
import type { Moment } from "./track";
import type { Point } from "./ways";

export interface Camera {
  x: number;
  y: number;
  /** Binary logarithm of pixels per metre. */
  zoom: number;
}

/** Whether the processor draws, because the browser has no GPU. Smooth edges would take half of a frame's time. */
function drawsInSoftware(): boolean {
  const probe = document.createElement("canvas").getContext("webgl2");
  const names = probe?.getExtension("WEBGL_debug_renderer_info");
  const renderer = names ? String(probe?.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(renderer);
}

export class MapCanvas {
  private readonly deck: Deck<OrthographicView[]>;
  private theme: Theme = light;
  private stacked = false;
  private cameras: Camera[] = [];

  constructor(
    private readonly place: HTMLElement,
    private readonly drawing: Drawing,
    readonly panes: Pane[],
    private readonly events: { moved(camera: Camera): void; drawn(): void; failed(why: string): void },
  ) {
    this.deck = new Deck<OrthographicView[]>({
      parent: place as HTMLDivElement,
      views: this.views(),
      controller: { scrollZoom: false, keyboard: false, dragRotate: false },
      touchAction: "pan-y",
      useDevicePixels: true,
      deviceProps: { type: "webgl", webgl: { preserveDrawingBuffer: true, antialias: !drawsInSoftware() } },
      layerFilter: ({ layer, viewport }) => !layer.id.includes(":") || layer.id.startsWith(`${viewport.id}:`),
      onViewStateChange: ({ viewState, interactionState }) => {
        const { isDragging, isPanning, isZooming } = interactionState as Record<string, boolean | undefined>;
        if (isDragging !== true && isPanning !== true && isZooming !== true) return viewState;
        const [x, y] = viewState.target as [number, number];
        this.events.moved({ x, y, zoom: viewState.zoom as number });
        return viewState;
      },
      onAfterRender: () => this.events.drawn(),
      onError: (error) => this.events.failed(error.message),
      layers: [],
    });
    this.recolour();
  }

  /** Takes the colours of the page: light or dark. */
  recolour(): void {
    this.theme = matchMedia("(prefers-color-scheme: dark)").matches && !matchMedia("print").matches ? dark : light;
    this.place.style.background = `rgb(${this.theme.background.slice(0, 3).join(",")})`;
  }

  /** What a click at a place of the map, in CSS pixels from its upper left corner, is meant for. */
  thingAt(left: number, top: number): Thing | undefined {
    const reach_px = 18;
    const [width, height] = this.paneSize();
    const index = Math.min(this.panes.length - 1, Math.floor(this.stacked ? top / height : left / width));
    const camera = this.cameras[index];
    if (camera === undefined) return undefined;
    const scale = 2 ** camera.zoom;
    const x = camera.x + (left - (this.stacked ? 0 : index * width) - width / 2) / scale;
    const y = camera.y - (top - (this.stacked ? index * height : 0) - height / 2) / scale;
    return (this.panes[index] as Pane).nearest(x, y, reach_px / scale);
  }

  /** Pane size in CSS pixels. */
  paneSize(): [number, number] {
    const { clientWidth, clientHeight } = this.place;
    const count = this.panes.length;
    return this.stacked ? [clientWidth, clientHeight / count] : [clientWidth / count, clientHeight];
  }

  /** The camera that shows the whole network. */
  whole(): Camera {
    return this.around([[0, 0], this.drawing.size_m]);
  }

  /** The camera that shows all of these places, of which there is at least one. */
  around(places: Point[], margin_m = 10): Camera {
    const [left, low] = [0, 1].map((axis) => Math.min(...places.map((place) => place[axis] as number))) as Point;
    const [right, high] = [0, 1].map((axis) => Math.max(...places.map((place) => place[axis] as number))) as Point;
    const [width, height] = this.paneSize();
    const scale = Math.min(width / (right - left + 2 * margin_m), height / (high - low + 2 * margin_m));
    return { x: (left + right) / 2, y: (low + high) / 2, zoom: Math.log2(Math.max(scale, 1e-3)) };
  }

  draw(moments: Moment[], cameras: Camera[], shown: Shown): void {
    this.cameras = cameras;
    const metresPerPixel = 2 ** -(cameras[0] as Camera).zoom;
    const { lanes } = this.drawing;
    const layers: Layer[] = [new RoadLayer({ id: "roads", lanes, colours: this.theme.lanes, metresPerPixel })];
    const viewState: Record<string, OrthographicViewState> = {};
    this.panes.forEach((pane, i) => {
      const camera = cameras[i] as Camera;
      layers.push(...pane.layers(moments[i] as Moment, shown, this.theme, 2 ** -camera.zoom));
      viewState[String(i)] = { target: [camera.x, camera.y, 0], zoom: camera.zoom };
    });
    this.deck.setProps({ layers, viewState } as never);
  }

  /** Stacks the panes where they would be too narrow side by side. */
  layOut(): void {
    const stacked = this.panes.length > 1 && this.place.clientWidth < 640;
    if (stacked === this.stacked) return;
    this.stacked = stacked;
    this.place.classList.toggle("stacked", stacked);
    this.deck.setProps({ views: this.views() } as never);
  }

  end(): void {
    this.deck.finalize();
  }

  private views(): OrthographicView[] {
    const count = this.panes.length;
    const share = (i: number, along: boolean) => (along ? `${(100 * i) / count}%` : "0%");
    const size = (along: boolean) => (along ? `${100 / count}%` : "100%");
    return this.panes.map(
      (_, i) =>
        new OrthographicView({
          id: String(i),
          flipY: false,
          x: share(i, !this.stacked),
          y: share(i, this.stacked),
          width: size(!this.stacked),
          height: size(this.stacked),
        } as never),
    );
  }
}
