/** Which room of the frontend may import which: each only those behind it in a row, rooms side by side not each other. */
const ROOMS = [
  ["app"],
  ["pages"],
  ["run", "simulation", "editor", "compare"],
  ["scene3d", "device"],
  ["shell"],
  ["program"],
  ["live"],
  ["map"],
  ["api"],
  ["i18n"],
  ["design"],
  ["offline"],
];
const EDITOR = [
  ["parts"],
  ["inspector"],
  ["commands"],
  ["gestures", "zones"],
  ["script"],
  ["canvas"],
  ["state"],
  ["shared"],
  ["edits"],
];
const INSPECTOR = [["forms"], ["expression"], ["fields"]];
const PROGRAM = [["canvas"], ["painting"], ["scene"], ["words"], ["document"]];
const MAP = [["robots", "floor", "devices"], ["plane"]];

/** For each room a rule: nothing before it in the row, and nothing beside it. */
function layers(name, folder, rows) {
  return rows.flatMap((row, at) =>
    row.map((room) => ({
      name: `${name}-${room}`,
      severity: "error",
      from: { path: `^${folder}/${room}/` },
      to: { path: `^${folder}/(${[...rows.slice(0, at).flat(), ...row.filter((each) => each !== room)].join("|")})/` },
    })),
  ).filter((rule) => !rule.to.path.endsWith("/()/"));
}

/** What stands in a room's folder itself brings its inner rooms together; they do not know it. */
function inner(name, folder, rows, open = "") {
  const rooms = rows.flat().join("|");
  return {
    name: `${name}-inner-rooms-do-not-know-what-holds-them`,
    severity: "error",
    from: { path: `^${folder}/(${rooms})/` },
    to: { path: `^${folder}/[^/]+\\.tsx?$`, ...(open ? { pathNot: open } : {}) },
  };
}

module.exports = {
  forbidden: [
    { name: "no-cycles", severity: "error", from: {}, to: { circular: true } },
    { name: "no-room-imports-main", severity: "error", from: { path: "^src/[^/]+/" }, to: { path: "^src/[^/]+\\.tsx?$" } },
    ...layers("room", "src", ROOMS),
    ...layers("editor", "src/editor", EDITOR),
    inner("editor", "src/editor", EDITOR),
    ...layers("inspector", "src/editor/inspector", INSPECTOR),
    inner("inspector", "src/editor/inspector", INSPECTOR),
    ...layers("program", "src/program", PROGRAM),
    inner("program", "src/program", PROGRAM, "^src/program/(kinds|surroundings|operation)\\.ts$"),
    ...layers("map", "src/map", MAP),
    inner("map", "src/map", MAP, "^src/map/PathLine\\.tsx$"),
    { name: "testing-only-in-tests", severity: "error", from: { pathNot: "^src/testing/|\\.test\\.tsx?$" }, to: { path: "^src/testing/" } },
    { name: "three-only-in-scene3d", severity: "error", from: { pathNot: "^src/scene3d" }, to: { path: "node_modules/(three|@react-three)" } },
    { name: "yjs-only-in-shared", severity: "error", from: { pathNot: "^src/editor/(shared|edits/concurrency\\.test\\.ts|script/difference\\.test\\.ts)" }, to: { path: "node_modules/(yjs|y-websocket|y-indexeddb)" } },
  ],
  options: { doNotFollow: { path: "node_modules" }, tsConfig: { fileName: "tsconfig.json" }, tsPreCompilationDeps: true },
};
