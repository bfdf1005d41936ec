import uPlotStyle from "uplot/dist/uPlot.min.css?inline";
import ownStyle from "./style.css?inline";

/** Adopts the styles as objects: a strict policy need not allow any text as style. */
export function adoptStyle(): void {
  for (const text of [uPlotStyle, ownStyle]) {
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(text);
    document.adoptedStyleSheets.push(sheet);
  }
}
