import { defineConfig } from "vite";

// One classic script that a page carries inside it: no imports, no chunks, no eval, the same bytes every time.
export default defineConfig({
  build: {
    target: "es2022",
    outDir: "dist",
    emptyOutDir: true,
    cssCodeSplit: false,
    modulePreload: false,
    license: { fileName: "licenses.md" },
    lib: { entry: "src/main.ts", formats: ["iife"], name: "ClearwayPage", fileName: () => "player.js" },
  },
  define: { "process.env.NODE_ENV": JSON.stringify("production") },
});
