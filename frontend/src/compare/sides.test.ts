import { expect, test } from "vitest";
import type { RunSummary } from "@/api/types";
import {
  compareAddress,
  DRAFT,
  isOneVersion,
  otherSide,
  otherSideOf,
  runSide,
  sidesOf,
  versionOfSide,
  versionTitle,
} from "./sides";

const run = (id: string, version: number | null) => ({ id, version }) as RunSummary;

test("a side is a version, what is drawn now, or what a run ran", () => {
  const runs = [run("r1", 3), run("r2", null)];
  expect(versionOfSide("7", runs)).toBe("7");
  expect(versionOfSide(DRAFT, runs)).toBe("draft");
  expect(versionOfSide(runSide("r1"), runs)).toBe("3");
  expect(versionOfSide(runSide("r2"), runs)).toBeNull();
  expect(versionOfSide(runSide("gone"), runs)).toBeNull();
  for (const nonsense of ["", "0", "-1", "7b", "<script>", "99999999999"])
    expect(versionOfSide(nonsense, [])).toBeNull();
});

test("an address that names no sides compares the newest version with what is drawn now", () => {
  expect(sidesOf(new URLSearchParams(), 4)).toEqual({ old: "4", new: "draft" });
  expect(sidesOf(new URLSearchParams(), undefined)).toEqual({ old: "draft", new: "draft" });
  const address = new URL(compareAddress("p", "2", runSide("r1")), "http://here").searchParams;
  expect(sidesOf(address, 4)).toEqual({ old: "2", new: "run:r1" });
});

test("a version without a name says why it was made", () => {
  const t = (key: string) => key;
  expect(versionTitle({ name: "Checked", cause: "run" }, t)).toBe("Checked");
  expect(versionTitle({ name: "", cause: "run" }, t)).toBe("compare.cause.run");
  expect(versionTitle({ name: "", cause: "" }, t)).toBe("compare.unnamed");
});

test("a side may be of another program, and of nothing else that is written so", () => {
  const program = "0e9debeb-1234-4ac5-813a-ae366d58caa6";
  expect(otherSide(otherSideOf(program, 7))).toEqual({ program, version: "7" });
  expect(versionOfSide(otherSideOf(program, DRAFT), [])).toBe(`${program}:draft`);
  expect(["run:x", `${program}:0`, `${program}:`, "x:7", "7", DRAFT].map(otherSide)).toEqual(Array(6).fill(null));
});

test("what is drawn now is no version, beside itself neither", () => {
  const program = "0e9debeb-1234-4ac5-813a-ae366d58caa6";
  const both = [
    ["1", "1"],
    ["1", "2"],
    [DRAFT, DRAFT],
    [`${program}:draft`, `${program}:draft`],
  ] as const;
  expect(both.map(isOneVersion)).toEqual([true, false, false, false]);
});
