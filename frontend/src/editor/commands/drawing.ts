/** Commands that take a tool, and those of the zone that is being drawn. */
import { CornerDownLeft, Ellipsis, Hand, MousePointer2, Undo2, X } from "lucide-react";
import { flushSync } from "react-dom";
import type { Kind } from "@/program/kinds";
import { RESTING, takeTool } from "../state/tool";
import { TOOLS } from "../state/tools";
import { useUi } from "../state/ui";
import { closeZone, dropCorner, leaveZone } from "../zones/zoneTool";
import { command, needsRight, vipoIcon, type Command } from "./command";

/** Its key takes it in hand, and devices are chosen by typing then; the same twice keeps it. */
function toolCommand(kind: Kind): Command {
  return command({
    id: toolId(kind.kind),
    group: "draw",
    words: {
      name: `editor.kind.${kind.kind}`,
      about: `editor.about.${kind.kind}`,
      also: `editor.also.${kind.kind}`,
    },
    icon: vipoIcon(kind.icon),
    keys: kind.key ? [kind.key] : [],
    whyNot: needsRight,
    run: (_open, { keys }) =>
      useUi.setState(({ gesture }) => ({
        gesture: takeTool(gesture, kind.kind, keys !== undefined),
        more: false,
      })),
  });
}

export function toolId(kind: string): string {
  return `tool_${kind}`;
}

const DRAW = { group: "draw" } as const;
const ZONE = { group: "draw", when: "drawing_zone", whyNot: needsRight, onlyKeys: true } as const;

export const DRAW_COMMANDS: readonly Command[] = [
  command({
    id: "select",
    ...DRAW,
    icon: MousePointer2,
    keys: ["V"],
    run: () => useUi.setState({ gesture: RESTING }),
  }),
  command({
    id: "pan",
    ...DRAW,
    icon: Hand,
    keys: ["H"],
    run: () => useUi.setState({ gesture: takeTool(RESTING, "pan", false) }),
  }),
  ...TOOLS.map(toolCommand),
  command({
    id: "more",
    ...DRAW,
    icon: Ellipsis,
    keys: ["."],
    whyNot: needsRight,
    // It is there at once: what is typed right after its key must not choose tools.
    run: () => flushSync(() => useUi.setState({ more: true })),
  }),
  command({ id: "zone_close", ...ZONE, icon: CornerDownLeft, keys: ["Enter"], fixed: true, run: closeZone }),
  command({ id: "zone_corner_back", ...ZONE, icon: Undo2, keys: ["Backspace"], run: dropCorner }),
  command({ id: "zone_leave", ...ZONE, icon: X, keys: ["Escape"], fixed: true, run: leaveZone }),
];
