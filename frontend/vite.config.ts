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

export default defineConfig({
  plugins: [react(), VitePWA(worker), compressed()],
  resolve: { alias: { "@": fileURLToPath(new URL("./src", import.meta.url)) } },
  build: { target: "es2022", sourcemap: false, chunkSizeWarningLimit: 1500 },
  test: { testTimeout: 60_000 }, // for what hangs: beside the other tests, a first drawing takes seconds
  server: { proxy: { "/api": backend, "/ws": { target: backend.replace("http", "ws"), ws: true } } },
});
