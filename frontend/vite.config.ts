import { fileURLToPath } from "node:url";
import react from "@vitejs/plugin-react";
import { defineConfig } from "vite";
import { VitePWA } from "vite-plugin-pwa";

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
    globPatterns: ["index.html", "theme.js", "favicon.svg", "assets/*.{js,css}", "assets/*-latin-{wght,400,600}-*.woff2"],
    globIgnores: ["**/Scene3D*", "**/SimulationScreen*"],
    maximumFileSizeToCacheInBytes: 3_000_000,
  },
};

export default defineConfig({
  plugins: [react(), VitePWA(worker)],
  resolve: { alias: { "@": fileURLToPath(new URL("./src", import.meta.url)) } },
  build: { target: "es2022", sourcemap: false, chunkSizeWarningLimit: 1500 },
  server: { proxy: { "/api": backend, "/ws": { target: backend.replace("http", "ws"), ws: true } } },
});
