// @vitest-environment jsdom
import { expect, test } from "vitest";
import { clip, clippingToText } from "../edits/clipping";
import { EMPTY_DOCUMENT, type ProgramDocument } from "@/program/document/document";
import type { OpenProgram } from "../state/context";
import { answerWaiting, useWaiting } from "../state/putting";
import { select, useUi } from "../state/ui";
import { copyToSystem, drawnAs, hasCopied, pasteCopied } from "./clipboard";

const document: ProgramDocument = {
  ...EMPTY_DOCUMENT,
  steps: { a: { kind: "wait", place: ["program", "body", "A"], pos: [3, -4], params: { duration: 5 } } },
};
const drawn = clippingToText(clip(document, ["a"]));
const TEXT = "class Task(object):\n    def new_task(self):\n        self.wait(5)\n";
const kept = JSON.stringify({ text: TEXT, drawn, names: { oven: "Oven" } });

test("script that was copied here is drawn as it stood", () => {
  const found = drawnAs(TEXT.replaceAll("\n", "\r\n"), kept);
  expect(found?.clipping.steps.a?.pos).toEqual([3, -4]);
  expect(found?.names).toEqual({ oven: "Oven" });
});

test("other script is not, and neither is anything where nothing sound is kept", () => {
  expect(drawnAs(TEXT.replace("5", "6"), kept)).toBeNull();
  expect(drawnAs(TEXT, null)).toBeNull();
  expect(drawnAs(TEXT, "{")).toBeNull();
});

test("a clipping as text is taken as before", () => {
  expect(drawnAs(drawn, null)?.clipping.outer).toEqual(["a"]);
});

test("the menu pastes what was copied before the page was opened anew, with the names of what it is about", () => {
  const steps: ProgramDocument["steps"] = {
    bake: { kind: "operate", place: ["program", "body", "A"], pos: [3, -4], params: { device: { device: "oven" } } },
  };
  const from = { ...EMPTY_DOCUMENT, steps };
  const open = (document: ProgramDocument, devices: { id: string; name: string }[]) => {
    const shared = { getSaving: () => ({ waiting: 1 }), getDocument: () => document };
    return { document, devices, shared, program: { id: "a" }, plan: null } as unknown as OpenProgram;
  };
  const asksFor = () => {
    pasteCopied(open(EMPTY_DOCUMENT, []));
    const names = useWaiting.getState().waiting?.strangers.map(({ name }) => name);
    answerWaiting(null);
    return names;
  };
  useUi.setState({ clipboard: null });
  expect([hasCopied(), asksFor()]).toEqual([false, undefined]);
  select(["bake"]);
  copyToSystem(open(from, [{ id: "oven", name: "Big oven" }]), false);
  expect([hasCopied(), asksFor()]).toEqual([true, ["Big oven"]]);
  useUi.setState({ clipboard: null });
  expect([hasCopied(), asksFor()]).toEqual([true, ["Big oven"]]);
});
