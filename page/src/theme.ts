// Colours of the map, light and dark. One colour means one thing on the whole page.

export type Rgba = [number, number, number, number];

export interface Theme {
  background: Rgba;
  lanes: { road: Rgba; junction: Rgba; walk: Rgba };
  /** By class: human, automated, emergency. */
  vehicles: [Rgba, Rgba, Rgba];
  /** Links that are true, observed, believed. */
  links: [Rgba, Rgba, Rgba];
  ghost: Rgba;
  sigma: Rgba;
  lease: Rgba;
  alarm: Rgba;
  chosen: Rgba;
  way: Rgba;
  block: Rgba;
  /** The bar of its sign. */
  bar: Rgba;
  /** The lanes of a blocked road. */
  closed: Rgba;
  signals: { go: Rgba; yield: Rgba; wait: Rgba; stop: Rgba; off: Rgba };
}

const shared = {
  vehicles: [
    [214, 154, 0, 255],
    [32, 110, 235, 255],
    [225, 0, 40, 255],
  ] as [Rgba, Rgba, Rgba],
  lease: [214, 0, 196, 255] as Rgba,
  alarm: [255, 90, 0, 255] as Rgba,
  block: [200, 0, 30, 255] as Rgba,
  bar: [255, 255, 255, 255] as Rgba,
  closed: [200, 0, 30, 110] as Rgba,
  signals: {
    go: [0, 165, 80, 255],
    yield: [130, 200, 60, 255],
    wait: [250, 190, 0, 255],
    stop: [200, 30, 30, 255],
    off: [128, 128, 128, 255],
  } as Theme["signals"],
};

export const light: Theme = {
  ...shared,
  background: [246, 246, 242, 255],
  lanes: { road: [205, 207, 212, 255], junction: [216, 218, 222, 255], walk: [228, 224, 214, 255] },
  links: [
    [90, 90, 90, 150],
    [32, 110, 235, 150],
    [0, 130, 70, 190],
  ],
  ghost: [110, 60, 160, 255],
  sigma: [110, 60, 160, 50],
  chosen: [28, 31, 36, 255],
  way: [0, 140, 150, 220],
};

export const dark: Theme = {
  ...shared,
  background: [18, 20, 24, 255],
  lanes: { road: [58, 62, 70, 255], junction: [50, 53, 60, 255], walk: [44, 43, 40, 255] },
  links: [
    [200, 200, 200, 130],
    [110, 170, 255, 150],
    [80, 220, 150, 190],
  ],
  ghost: [190, 150, 235, 255],
  sigma: [190, 150, 235, 60],
  chosen: [255, 255, 255, 255],
  way: [70, 205, 215, 220],
};

/** The colour of SUMO's letter for a link of a signal. */
export function signalColour(letter: string | undefined, theme: Theme): Rgba {
  switch (letter) {
    case "G":
      return theme.signals.go;
    case "g":
      return theme.signals.yield;
    case "y":
    case "Y":
    case "u":
      return theme.signals.wait;
    case "r":
    case "R":
    case "s":
      return theme.signals.stop;
    default:
      return theme.signals.off;
  }
}
