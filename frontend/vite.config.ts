import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { brotliCompressSync, constants, gzipSync } from "node:zlib";
import react from "@vitejs/plugin-react";
import type { Plugin } from "vite";
import { VitePWA } from "vite-plugin-pwa";
import { defineConfig } from "vitest/config";
import { BaseSequencer } from "vitest/node";

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

/** What hands on the parts of a library: whoever imports from it needs the parts that it names, and not all of them. */
const INDEX = /\/(@mantine\/(core|hooks|notifications)\/esm\/index|lucide-react\/dist\/esm\/lucide-react)\.mjs$/;
const NAMED_IMPORT = /import\s*\{([^}]*)\}\s*from\s*["']([^"']+)["']/g;
const HANDED_ON = /(?:import|export)\s*\{([^}]*)\}\s*from\s*["'](\.[^"']+)["']/g;

/** Which module holds each name that an index hands on. */
function heldBy(index: string, code: string): Map<string, string> {
  const found = new Map<string, string>();
  for (const [, names = "", path = ""] of code.matchAll(HANDED_ON))
    for (const name of names.split(",")) found.set(name.trim().replace(/^.* as /, ""), join(dirname(index), path));
  return found;
}

/** The names that a module imports from a library. */
function namedImports(code: string, library: string): string[] {
  const found = [...code.matchAll(NAMED_IMPORT)].filter(([, , from]) => from === library);
  return found.flatMap(([, names = ""]) => names.split(",").map((name) => name.trim().replace(/ as .*$/, "")));
}

interface Graph {
  importsOf: (id: string) => readonly string[];
  codeOf: (id: string) => string;
}

/** What a module imports, with the parts that it names in the place of an index. */
function importedParts({ importsOf, codeOf }: Graph): (id: string) => string[] {
  const parts = new Map<string, Map<string, string>>();
  const partsOf = (index: string) => {
    const known = parts.get(index) ?? heldBy(index, codeOf(index));
    parts.set(index, known);
    return known;
  };
  return (id) =>
    importsOf(id).flatMap((imported) => {
      if (!INDEX.test(imported)) return [imported];
      const library = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(imported)?.[1] ?? "";
      return namedImports(codeOf(id), library).flatMap((name) => partsOf(imported).get(name) ?? []);
    });
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

/** Screens beside the editor's. */
const SCREEN = /\/src\/(pages\/[^/]+\/\w+Page|(compare|run|simulation)\/.*Screen)\.tsx$/;

/** What the editor shows beside the map, which does not wait for it. */
const BESIDE = /\/src\/editor\/(inspector\/ProgramPanel|beginning\/(EmptyProgram|NextSteps)|parts\/DrawerBody)\.tsx$/;

/**
 * Dialogs and forms of the editor, all of which it fetches soon after the program has come; what it adds to the palette
 * comes before them.
 */
const LATER = /\/src\/editor\/((beginning|canvas|commands|dialogs|inspector|zones)\/(?!offer\.ts)|gestures\/GhostCard)/;

/** Bytes, below which what some pages share joins what others share. */
const SMALL = 5_000;

/**
 * Few scripts instead of one for each set of pages that share a module, which were hundreds (ADR 76, 88). What every
 * page begins with is one, and what opening a program needs besides is two: nothing else has to come before one can
 * draw. What two other screens share is one more, and so is what the editor fetches soon afterwards.
 */
function scripts() {
  let first = new Set<string>();
  let opening = new Set<string>();
  let several = new Set<string>();
  let beside = new Set<string>();
  let later = new Set<string>();
  const plugin: Plugin = {
    name: "scripts",
    apply: "build",
    buildEnd() {
      const ids = [...this.getModuleIds()];
      const importsOf = importedParts({
        importsOf: (id) => this.getModuleInfo(id)?.importedIds ?? [],
        codeOf: (id) => this.getModuleInfo(id)?.code ?? "",
      });
      first = needed("/src/main.tsx", ids, importsOf);
      opening = needed("/src/editor/EditorScreen.tsx", ids, importsOf);
      const screens = ids.filter((id) => SCREEN.test(id)).map((id) => needed(id, ids, importsOf));
      const elsewhere = new Set(screens.flatMap((screen) => [...screen]));
      several = new Set([...elsewhere].filter((id) => screens.filter((screen) => screen.has(id)).length > 1));
      const asked = ids.flatMap((id) => this.getModuleInfo(id)?.dynamicallyImportedIds ?? []);
      const askedFor = (these: RegExp) =>
        asked
          .filter((id) => these.test(id))
          .flatMap((id) => [...needed(id, ids, importsOf)])
          .filter((id) => !elsewhere.has(id));
      beside = new Set(askedFor(BESIDE));
      later = new Set(askedFor(LATER).filter((id) => !beside.has(id)));
    },
  };
  const groups = [
    { name: "first", test: (id: string) => first.has(id), priority: 4 },
    { name: "common", test: (id: string) => opening.has(id), minShareCount: MANY, priority: 3 },
    { name: "drawing", test: (id: string) => opening.has(id), minShareCount: 2, priority: 2 },
    { name: "EditorScreen", test: (id: string) => opening.has(id), priority: 1 },
    // Joined with whatever is small, an icon would bring pages along.
    { name: "icons", test: /\/lucide-react\//, minShareCount: 2, priority: 1 },
    // The editor of texts would come along with what is small beside it.
    { name: "text", test: /\/node_modules\/(@codemirror|@lezer|codemirror)\//, minShareCount: 2, priority: 2 },
    { name: "pages", test: (id: string) => several.has(id), priority: 1 },
    {
      name: "shared",
      test: (id: string) => !beside.has(id) && !later.has(id),
      minShareCount: 2,
      entriesAware: true,
      entriesAwareMergeThreshold: SMALL,
      priority: 1,
    },
    { name: "beside", test: (id: string) => beside.has(id), priority: 1 },
    { name: "later", test: (id: string) => later.has(id) },
  ];
  const chunkFileNames = ({ name }: { name: string }) => `assets/${name.split("~", 1)[0]}-[hash].js`;
  return { plugin, output: { codeSplitting: { groups }, chunkFileNames } };
}

const { plugin, output } = scripts();
const here = (path: string) => fileURLToPath(new URL(path, import.meta.url));
/** What Yjs writes to the console in colours brings a library of schemas along in browsers; this variant does not. */
const PLAIN_LOG = { "lib0/logging": here("./node_modules/lib0/logging.node.js") };

/** Files of tests share modules, so their order is one and the same: by default it goes by how long each took last. */
class ByName extends BaseSequencer {
  override sort(files: Parameters<BaseSequencer["sort"]>[0]) {
    return Promise.resolve(files.toSorted((a, b) => (a.moduleId < b.moduleId ? -1 : 1)));
  }
}

export default defineConfig({
  plugins: [react(), VitePWA(worker), compressed(), plugin],
  resolve: { alias: { "@": here("./src"), ...PLAIN_LOG } },
  build: { target: "es2022", sourcemap: false, chunkSizeWarningLimit: 1500, rolldownOptions: { output } },
  // For what hangs: beside the other tests, a first drawing and the fetching of texts take seconds.
  test: {
    pool: "threads",
    isolate: false,
    sequence: { sequencer: ByName },
    setupFiles: "./vitest.setup.ts",
    testTimeout: 60_000,
    hookTimeout: 60_000,
    expect: { poll: { timeout: 20_000 } },
  },
  server: { proxy: { "/api": backend, "/ws": { target: backend.replace("http", "ws"), ws: true } } },
});
