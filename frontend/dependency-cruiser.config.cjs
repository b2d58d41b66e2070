/** What may import what in the frontend: screens use parts, parts never use screens. */
module.exports = {
  forbidden: [
    { name: "no-cycles", severity: "error", from: {}, to: { circular: true } },
    { name: "design-knows-nothing", severity: "error", from: { path: "^src/design" }, to: { path: "^src/(pages|editor|run|simulation|map|live|api)" } },
    { name: "map-knows-no-screen", severity: "error", from: { path: "^src/map" }, to: { path: "^src/(pages|editor|run|simulation)" } },
    { name: "screens-are-apart", severity: "error", from: { path: "^src/editor" }, to: { path: "^src/(pages|run|simulation)" } },
    { name: "three-only-in-simulation", severity: "error", from: { pathNot: "^src/simulation" }, to: { path: "node_modules/(three|@react-three)" } },
    { name: "yjs-only-in-editor", severity: "error", from: { pathNot: "^src/editor" }, to: { path: "node_modules/(yjs|y-websocket|y-indexeddb)" } },
  ],
  options: { doNotFollow: { path: "node_modules" }, tsConfig: { fileName: "tsconfig.json" }, tsPreCompilationDeps: true },
};
