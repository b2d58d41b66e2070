import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import react from "@vitejs/plugin-react";
import type { Plugin } from "vite";
import { VitePWA } from "vite-plugin-pwa";
import { defineConfig } from "vitest/config";

const backend = process.env.VIPO_BACKEND ?? "http://127.0.0.1:8000";

/** The service worker, /worker.js: the shell of the application that it keeps is what the editor needs. */
const worker: Parameters<typeof VitePWA>[0] = {
  strategies: "injectManifest",
  srcDir: "src/offline",
  filename: "worker.ts",
  injectRegister: false,
  manifest: false,
  injectManifest: {
    rollupFormat: "iife",
    globPatterns: [
      "index.html",
      "theme.js",
      "favicon.svg",
      "assets/*.{js,css}",
      "assets/*-latin-{wght,400,600}-*.woff2",
    ],
    globIgnores: ["**/Scene3D*", "**/SimulationScreen*"],
    maximumFileSizeToCacheInBytes: 3_000_000,
  },
};

/** Bytes; many scripts are small, and together they are not. */
const WORTH_COMPRESSING = 200;

/** Beside each text of the build stands what a browser is sent that reads it compressed (servestatic finds it). */
function compressed(): Plugin {
  let folder = "";
  return {
    name: "compressed",
    apply: "build",
    configResolved: (config) => void (folder = join(config.root, config.build.outDir, "assets")),
    closeBundle() {
      for (const name of readdirSync(folder).filter((each) => /\.(js|css|svg)$/.test(each))) {
        const path = join(folder, name);
        const content = readFileSync(path);
        if (content.length < WORTH_COMPRESSING) continue;
        writeFileSync(`${path}.gz`, gzipSync(content, { level: 9 }));
        const params = { [constants.BROTLI_PARAM_QUALITY]: 11, [constants.BROTLI_PARAM_SIZE_HINT]: content.length };
        writeFileSync(`${path}.br`, brotliCompressSync(content, { params }));
      }
    },
  };
}

/** All that a module needs at once: what it imports, but for what it imports when it is asked for. */
function needed(start: string, ids: Iterable<string>, importsOf: (id: string) => readonly string[]): Set<string> {
  const found = new Set<string>();
  const waiting = [...ids].filter((id) => id.endsWith(start));
  for (let id = waiting.pop(); id !== undefined; id = waiting.pop()) {
    if (found.has(id)) continue;
    found.add(id);
    waiting.push(...importsOf(id));
  }
  return found;
}

/** Pages and dialogs that share a module, from which on it counts as needed everywhere. */
const MANY = 6;

/** Bytes, below which what some pages share joins what others share. */
const SMALL = 5_000;

/**
 * Few scripts instead of one for each set of pages that share a module, which were hundreds (ADR 76). What every page
 * begins with is one, and what opening a program needs besides is two: nothing else has to come before one can draw.
 */
function scripts() {
  let first = new Set<string>();
  let opening = new Set<string>();
  const plugin: Plugin = {
    name: "scripts",
    apply: "build",
    buildEnd() {
      const ids = [...this.getModuleIds()];
      const importsOf = (id: string) => this.getModuleInfo(id)?.importedIds ?? [];
      first = needed("/src/main.tsx", ids, importsOf);
      opening = needed("/src/editor/EditorScreen.tsx", ids, importsOf);
    },
  };
  const groups = [
    { name: "first", test: (id: string) => first.has(id), priority: 3 },
    { name: "common", test: (id: string) => opening.has(id), minShareCount: MANY, priority: 2 },
    { name: "drawing", test: (id: string) => opening.has(id), minShareCount: 2, priority: 1 },
    { name: "shared", minShareCount: 2, entriesAware: true, entriesAwareMergeThreshold: SMALL },
  ];
  const chunkFileNames = ({ name }: { name: string }) => `assets/${name.split("~", 1)[0]}-[hash].js`;
  return { plugin, output: { codeSplitting: { groups }, chunkFileNames } };
}

const { plugin, output } = scripts();

export default defineConfig({
  plugins: [react(), VitePWA(worker), compressed(), plugin],
  resolve: { alias: { "@": fileURLToPath(new URL("./src", import.meta.url)) } },
  build: { target: "es2022", sourcemap: false, chunkSizeWarningLimit: 1500, rolldownOptions: { output } },
  test: { testTimeout: 60_000 }, // for what hangs: beside the other tests, a first drawing takes seconds
  server: { proxy: { "/api": backend, "/ws": { target: backend.replace("http", "ws"), ws: true } } },
});
