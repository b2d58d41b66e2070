/** Commands that go from step to step, and to what is open beside the map. */
import {
  ArrowLeftRight,
  CircleAlert,
  CornerDownLeft,
  GitBranch,
  Keyboard,
  PanelBottom,
  SquareDashed,
  X,
} from "lucide-react";
import { createOnFloor } from "../state/newStep";
import type { OpenProgram } from "../state/context";
import { freeSpot } from "../state/freeSpot";
import { selectZone } from "../state/gestures";
import { chooseNextBranch } from "../state/nextPlace";
import { setsDownByEnter, stepBack } from "../state/tool";
import { select, showTab, useUi } from "../state/ui";
import { command, needsRight, type Command, type On } from "./command";
import { directionOf } from "./editing";

/** Keys on these are their own. */
const PRESSED_BY_ENTER = "button, a, [role=menuitem], [role=tab]";

/** The tool in hand sets its step down where there is room; without a tool the selected step is edited. */
function enter(open: OpenProgram, { target }: On): boolean {
  const { gesture, selected } = useUi.getState();
  if (target instanceof HTMLElement && target.closest(PRESSED_BY_ENTER)) return false;
  if (open.canEdit && setsDownByEnter(gesture)) {
    createOnFloor(open, gesture, freeSpot(open, gesture.tool));
    return true;
  }
  if (selected.length !== 1) return false;
  useUi.setState({ inspector: true });
  requestAnimationFrame(() => document.querySelector<HTMLElement>("[data-form] :is(input, textarea)")?.focus());
  return true;
}

function back(): void {
  const { gesture, fieldPick, into, selected, device } = useUi.getState();
  if (fieldPick) useUi.setState({ fieldPick: null });
  else if (gesture.tool !== "select") useUi.setState({ gesture: stepBack(gesture) });
  else if (into) useUi.setState({ into: null });
  else if (selected.length > 0) select([]);
  else if (device !== null) useUi.setState({ device: null });
}

function nextProblem({ diagnostics }: OpenProgram, by: 1 | -1): void {
  const steps = [...new Set(diagnostics.map((each) => each.step).filter(Boolean))];
  if (steps.length === 0) return;
  const at = steps.indexOf(useUi.getState().selected.at(-1) ?? "");
  const next = steps[(at + by + steps.length) % steps.length];
  if (next) select([next]);
  showTab("problems");
}

/** The nearest step in the direction of the arrow. */
function neighbour({ scene }: OpenProgram, { keys }: On): boolean {
  const from = scene.chips.get(useUi.getState().selected.at(-1) ?? "");
  const direction = directionOf(keys);
  if (!from) return false;
  let best: { id: string; far: number } | null = null;
  for (const chip of scene.chips.values()) {
    const [dx, dy] = [chip.at.x - from.at.x, from.at.y - chip.at.y];
    const ahead = dx * direction[0] + dy * direction[1];
    const aside = Math.abs(dx * direction[1]) + Math.abs(dy * direction[0]);
    const far = ahead + aside * 2;
    if (ahead > 4 && (!best || far < best.far)) best = { id: chip.id, far };
  }
  if (best) select([best.id]);
  return best !== null;
}

const GO = { group: "go" } as const;

const noProblem = ({ diagnostics }: OpenProgram) =>
  diagnostics.some((each) => each.step) ? null : "commands.why.no_problem";

export const GO_COMMANDS: readonly Command[] = [
  command({
    id: "enter",
    ...GO,
    icon: CornerDownLeft,
    keys: ["Enter"],
    fixed: true,
    onlyKeys: true,
    run: enter,
  }),
  command({ id: "back", ...GO, icon: X, keys: ["Escape"], fixed: true, onlyKeys: true, run: back }),
  command({
    id: "leave_zone",
    ...GO,
    icon: X,
    when: "zone",
    keys: ["Escape"],
    fixed: true,
    onlyKeys: true,
    run: () => selectZone(null),
  }),
  command({
    id: "neighbour",
    ...GO,
    when: "steps",
    icon: ArrowLeftRight,
    keys: ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"],
    fixed: true,
    onlyKeys: true,
    run: neighbour,
  }),
  command({
    id: "next_branch",
    ...GO,
    when: "steps",
    icon: GitBranch,
    keys: ["B"],
    whyNot: needsRight,
    run: (open) => chooseNextBranch(open, 1),
  }),
  command({
    id: "previous_branch",
    ...GO,
    when: "steps",
    icon: GitBranch,
    keys: ["Shift+B"],
    whyNot: needsRight,
    run: (open) => chooseNextBranch(open, -1),
  }),
  command({
    id: "select_all",
    ...GO,
    icon: SquareDashed,
    keys: ["Ctrl+A"],
    menus: ["floor"],
    whyNot: ({ scene }) => (scene.tree.reading.length > 0 ? null : "commands.why.no_steps_yet"),
    run: ({ scene }) => select(scene.tree.reading),
  }),
  command({
    id: "next_problem",
    ...GO,
    icon: CircleAlert,
    keys: ["F8"],
    whyNot: noProblem,
    run: (open) => nextProblem(open, 1),
  }),
  command({
    id: "previous_problem",
    ...GO,
    icon: CircleAlert,
    keys: ["Shift+F8"],
    whyNot: noProblem,
    run: (open) => nextProblem(open, -1),
  }),
  command({
    id: "drawer",
    ...GO,
    icon: PanelBottom,
    keys: ["Ctrl+J"],
    run: () => useUi.setState(({ drawer }) => ({ drawer: { ...drawer, open: !drawer.open } })),
  }),
  command({
    id: "shortcuts",
    ...GO,
    icon: Keyboard,
    keys: ["?"],
    run: () => useUi.setState({ dialog: "shortcuts" }),
  }),
];
