// @vitest-environment jsdom
/** A field that waits for a press on the map waits no longer than it is looked at. */
import { MantineProvider } from "@mantine/core";
import { act, cleanup, fireEvent, render, screen } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { startI18n } from "@/i18n";
import { EMPTY_DOCUMENT, type Place, type ProgramDocument, type Step } from "@/program/document/document";
import { applyEdits, type Edit } from "../../edits/edits";
import { type OpenProgram, ProgramContext } from "../../state/context";
import { resetUi, select, showDevice, useUi } from "../../state/ui";
import { PlaceField } from "./PlaceField";
import { StepEditorContext, type StepEditor } from "./stepEditor";

const step = (args: Step["params"]): Step => ({ kind: "call", place: null, pos: [1, 1], params: { args } });
let document: ProgramDocument;
const apply = (edits: readonly Edit[]) => (document = applyEdits(document, edits));
const argsOf = (id: string) => document.steps[id]?.params.args as Readonly<Record<string, Place>>;

/** The argument `to` of step a, as the form of a call shows it. */
function Shown() {
  const args = argsOf("a");
  const open = { document, apply, devices: [], plan: null, diagnostics: [], t: (key: string) => key };
  const editor = { id: "a", step: document.steps.a, parameters: [], disabled: false, showEditing: () => undefined };
  return (
    <MantineProvider>
      <ProgramContext value={open as unknown as OpenProgram}>
        <StepEditorContext value={editor as unknown as StepEditor}>
          <PlaceField
            label="to"
            field="args.to"
            value={args.to ?? null}
            onChange={(place) => apply([{ do: "set_param", id: "a", name: "args", value: { ...args, to: place } }])}
          />
        </StepEditorContext>
      </ProgramContext>
    </MantineProvider>
  );
}

/** A press on a machine of the map, as it answers a field that waits. */
const pressMachine = (device: string) => useUi.getState().fieldPick?.choose(device);

beforeEach(async () => {
  await startI18n();
  document = { ...EMPTY_DOCUMENT, steps: { a: step({ to: { device: "mixer" } }), b: step({}) } };
  resetUi();
  act(() => select(["a"]));
});
afterEach(() => {
  cleanup();
  vi.unstubAllGlobals();
});

test("a press on a machine answers the field that waits for one", () => {
  render(<Shown />);
  fireEvent.click(screen.getByLabelText("field.pick_on_map"));
  pressMachine("store");
  expect(argsOf("a").to).toEqual({ device: "store" });
});

test.each([
  ["another step", () => select(["b"])],
  ["the floor", () => select([])],
  ["a device", () => showDevice("oven")],
])("a field waits no longer once somebody looks at %s", (_what, look) => {
  render(<Shown />);
  fireEvent.click(screen.getByLabelText("field.pick_on_map"));
  act(look);
  pressMachine("store");
  expect(argsOf("a").to).toEqual({ device: "mixer" });
});

test("a field that has gone waits no longer", () => {
  const { unmount } = render(<Shown />);
  fireEvent.click(screen.getByLabelText("field.pick_on_map"));
  unmount();
  expect(useUi.getState().fieldPick).toBeNull();
});

test("a field that goes leaves the one that waits", () => {
  const { rerender } = render(
    <>
      <Shown key="waits" />
      <Shown key="goes" />
    </>,
  );
  fireEvent.click(screen.getAllByLabelText("field.pick_on_map")[0] as Element);
  rerender(<Shown key="waits" />);
  pressMachine("store");
  expect(argsOf("a").to).toEqual({ device: "store" });
});

test("what was given meanwhile beside the place stays when the map is pressed", () => {
  const { rerender } = render(<Shown />);
  fireEvent.click(screen.getByLabelText("field.pick_on_map"));
  apply([{ do: "set_param", id: "a", name: "args", value: { to: { device: "mixer" }, by: { device: "robot" } } }]);
  rerender(<Shown />);
  pressMachine("store");
  expect(argsOf("a")).toEqual({ to: { device: "store" }, by: { device: "robot" } });
});
