import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { applyEdits, type Edit } from "../edits/edits";
import { EMPTY_DOCUMENT, type ProgramDocument, type Step } from "@/program/document/document";
import { ScriptSession, type DrawnScript, type ScriptRequest } from "./session";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

/** A language of one word, `wait N`, and the server and the shared document around it. */
class Place {
  document: ProgramDocument = EMPTY_DOCUMENT;
  ids = 0;
  asked: ScriptRequest[] = [];
  meanwhile: (() => void) | null = null;

  readonly session = new ScriptSession({
    draw: async (request) => {
      this.asked.push(request);
      const answer = draw(request);
      this.meanwhile?.();
      this.meanwhile = null;
      return Promise.resolve(answer);
    },
    getDocument: () => this.document,
    apply: (edits) => this.change(edits),
    makeId: () => `id${(this.ids += 1)}`,
  });

  change(edits: readonly Edit[]): void {
    if (edits.length > 0) this.document = applyEdits(this.document, edits);
  }

  /** The site's compiler has read the document. */
  compile(): void {
    this.session.show(print(this.document));
  }

  get durations(): unknown[] {
    return inOrder(this.document).map(([, step]) => step.params.duration);
  }

  async settle(): Promise<void> {
    await vi.advanceTimersByTimeAsync(1000);
  }
}

function inOrder(document: ProgramDocument): [string, Step][] {
  return Object.entries(document.steps).sort(([, a], [, b]) => ((a.place?.[2] ?? "") < (b.place?.[2] ?? "") ? -1 : 1));
}

function print(document: ProgramDocument): string {
  return inOrder(document)
    .map(([, step]) => `wait ${String(step.params.duration)}\n`)
    .join("");
}

function draw({ text, base, shown }: ScriptRequest): DrawnScript {
  const script = print(base);
  if (script !== shown) return { ok: false, stale: true, document: null, script, lines: [], diagnostics: [] };
  const lines = text.split("\n").filter((line) => line.trim());
  const wrong = lines.findIndex((line) => !/^\s*wait\s+\d+\s*$/.test(line));
  if (wrong >= 0) {
    const problem = { line: wrong + 1, column: 1, end_line: null, end_column: null, message: "No.", expected: "" };
    return { ok: false, stale: false, document: null, script, lines: [], diagnostics: [problem] };
  }
  const known = inOrder(base);
  const steps = lines.map((line, index): [string, Step] => {
    const [id, before] = known[index] ?? [`s${index}`, { kind: "wait", place: null, pos: [0, 0], params: {} }];
    const params = { ...before.params, duration: Number(line.trim().split(/\s+/)[1]) };
    return [id, { ...before, place: ["program", "body", String(index)], params }];
  });
  const document = { ...base, steps: Object.fromEntries(steps) };
  return { ok: true, stale: false, document, script: print(document), lines: [], diagnostics: [] };
}

async function place(text: string): Promise<Place> {
  const made = new Place();
  made.compile();
  made.session.type(text);
  await made.settle();
  made.compile();
  made.asked = [];
  return made;
}

test("what is typed is drawn after a pause, under ids of one's own", async () => {
  const here = new Place();
  here.compile();
  here.session.focus(true);
  here.session.type("wait 6");
  here.session.type("wait 60\n");
  expect(here.asked).toHaveLength(0);
  await here.settle();
  expect(here.asked).toHaveLength(1);
  expect(Object.keys(here.document.steps)).toEqual(["id1"]);
  expect(here.durations).toEqual([60]);
});

test("a text that means nothing leaves the drawing as it is, and says where", async () => {
  const here = await place("wait 60\nwait 5\n");
  here.session.type("wait 60\nwai 5\n");
  await here.settle();
  expect(here.durations).toEqual([60, 5]);
  expect(here.session.getState().problems.map((problem) => problem.line)).toEqual([2]);
  here.session.type("wait 60\nwait 7\n");
  await here.settle();
  expect(here.session.getState().problems).toEqual([]);
  expect(here.durations).toEqual([60, 7]);
});

test("the drawing comes into a text that nobody edits", async () => {
  const here = await place("wait 60\n");
  here.change([{ do: "set_param", id: "id1", name: "duration", value: 61 }]);
  here.compile();
  expect(here.session.getState()).toMatchObject({ text: "wait 61\n", own: false });
});

test("others' changes come into an own text, and nothing of either is lost", async () => {
  const here = await place("wait 1\nwait 2\nwait 3\n");
  here.session.focus(true);
  here.session.type("wait 1\nwait 2\nwait  33\n");
  here.change([{ do: "set_param", id: "id1", name: "duration", value: 11 }]);
  await here.settle();
  expect(here.durations).toEqual([11, 2, 33]);
  expect(here.session.getState().text).toBe("wait 11\nwait 2\nwait  33\n");
});

test("what others do while the server draws survives, too", async () => {
  const here = await place("wait 1\nwait 2\n");
  here.session.focus(true);
  here.meanwhile = () => here.change([{ do: "set_param", id: "id1", name: "duration", value: 11 }]);
  here.session.type("wait 1\nwait 22\n");
  await here.settle();
  expect(here.durations).toEqual([11, 22]);
  expect(here.session.getState().text).toBe("wait 11\nwait 22\n");
});

test("the same line changed by both: mine stays until it means something, other fields survive", async () => {
  const here = await place("wait 1\nwait 2\n");
  here.session.focus(true);
  here.session.type("wait 1\nwait twelve\n");
  await here.settle();
  here.change([
    { do: "set_param", id: "id2", name: "duration", value: 20 },
    { do: "set_param", id: "id2", name: "timeout", value: 9 },
  ]);
  here.compile();
  await here.settle();
  expect(here.session.getState().text).toBe("wait 1\nwait twelve\n");
  expect(here.session.getState().conflicts).toEqual([{ line: 2, theirs: ["wait 20"] }]);
  here.session.type("wait 1\nwait 12\n");
  await here.settle();
  expect(here.document.steps.id2?.params).toEqual({ duration: 12, timeout: 9 });
  expect(here.session.getState()).toMatchObject({ text: "wait 1\nwait 12\n", conflicts: [], problems: [] });
});

test("a text that was drawn takes a later change of the same line", async () => {
  const here = await place("wait 1\n");
  here.session.focus(true);
  here.session.type("wait   5\n");
  await here.settle();
  here.change([{ do: "set_param", id: "id1", name: "duration", value: 6 }]);
  here.compile();
  await here.settle();
  expect(here.durations).toEqual([6]);
  expect(here.session.getState().text).toBe("wait 6\n");
});

test("left alone, a text that is drawn gives way to its print; one that means nothing stays", async () => {
  const here = await place("wait 1\n");
  here.session.focus(true);
  here.session.type("wait    5\n");
  await here.settle();
  expect(here.session.getState().text).toBe("wait    5\n");
  here.session.focus(false);
  await here.settle();
  expect(here.session.getState()).toMatchObject({ text: "wait 5\n", own: false });
  here.session.type("wait\n");
  here.session.focus(false);
  await here.settle();
  expect(here.session.getState()).toMatchObject({ text: "wait\n", own: true });
  here.compile();
  here.session.discard();
  expect(here.session.getState()).toMatchObject({ text: "wait 5\n", own: false, problems: [] });
});

test("a step typed twice quickly is drawn once", async () => {
  const here = await place("wait 1\n");
  here.session.focus(true);
  here.meanwhile = () => here.session.type("wait 1\nwait 2\nwait 3\n");
  here.session.type("wait 1\nwait 2\n");
  await here.settle();
  expect(here.durations).toEqual([1, 2, 3]);
  expect(Object.keys(here.document.steps)).toHaveLength(3);
});
