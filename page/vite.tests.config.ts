import { defineConfig } from "vite";

// The decoder alone, as a module for the tests that need no browser.
export default defineConfig({
  build: {
    target: "es2022",
    outDir: ".build",
    lib: { entry: { stream: "src/stream.ts", track: "src/track.ts", drawing: "src/drawing.ts", curves: "src/curves.ts", ways: "src/ways.ts" }, formats: ["es"] },
  },
});
