/** Commands about a machine or robot, an arrow, and whatever is under the pointer. */
import { ArrowDownToDot, ListPlus, MonitorCog, Search, SearchCheck } from "lucide-react";
import { operable } from "@/program/operation";
import { deviceBox, type SiteDevice } from "@/program/surroundings";
import type { OpenProgram } from "../state/context";
import { drawAt, drawOnLink } from "../state/drawAt";
import { freeSpot } from "../state/freeSpot";
import { lastPointer } from "../state/screen";
import { onScreen, underPointer } from "../state/under";
import { toMetres } from "@/map/plane/projection";
import { showDevice, useUi } from "../state/ui";
import { command, needsRight, vipoIcon, type Command, type On } from "./command";

function deviceOf({ surroundings }: OpenProgram, { device }: On): SiteDevice | undefined {
  return surroundings.devices.get(device ?? useUi.getState().device ?? "");
}

/** A tool used at the machine of the menu. */
function here(id: string, kind: string, icon: string, missing: (device: SiteDevice) => string | null): Command {
  return command({
    id,
    group: "draw",
    icon: vipoIcon(icon),
    menus: ["machine"],
    whyNot: (open, on) => {
      const device = deviceOf(open, on);
      return needsRight(open, on) ?? (device ? missing(device) : "commands.why.no_device");
    },
    run: (open, on) => {
      const device = deviceOf(open, on);
      if (device) drawAt(open, kind, { step: null, link: null, device: device.id, at: middle(device) });
    },
  });
}

function middle(device: SiteDevice) {
  const { left, right, top, bottom } = deviceBox(device);
  return toMetres({ x: (left + right) / 2, y: (top + bottom) / 2 });
}

const noRobot = (device: SiteDevice) => (device.kind === "robot" ? "commands.why.robots_move" : null);

/** At the pointer, if it is over the map; else where a new step would go. */
function openQuickAdd(open: OpenProgram, { at, device, keys }: On): void {
  const pointed = keys === undefined ? null : lastPointer.at;
  const under = pointed ? underPointer(open, pointed) : null;
  const spot = at ?? under?.at ?? freeSpot(open);
  const screen = pointed ?? onScreen(spot);
  useUi.setState({ quick: { ...screen, at: spot, device: device ?? under?.device ?? null } });
}

export const MACHINE_COMMANDS: readonly Command[] = [
  command({
    id: "quick_add",
    group: "draw",
    icon: ListPlus,
    keys: ["/"],
    menus: ["floor", "machine"],
    whyNot: needsRight,
    run: openQuickAdd,
  }),
  command({
    id: "draw_next",
    group: "draw",
    icon: ArrowDownToDot,
    menus: ["arrow"],
    whyNot: (open, on) => needsRight(open, on) ?? (on.link ? null : "commands.why.no_arrow"),
    run: (open, on) => {
      if (on.link) drawOnLink(open, on.link);
      openQuickAdd(open, on);
    },
  }),
  here("operate_here", "operate", "operate", (device) =>
    operable(device).length > 0 ? null : "commands.why.no_methods",
  ),
  here(
    "pick_from_here",
    "pick_and_drop",
    "pickdrop",
    (device) => noRobot(device) ?? (device.gives.length > 0 ? null : "commands.why.gives_nothing"),
  ),
  here(
    "drop_here",
    "drop",
    "drop",
    (device) => noRobot(device) ?? (device.takes.length > 0 ? null : "commands.why.takes_nothing"),
  ),
  here("move_here", "move", "move", noRobot),
  command({
    id: "device",
    group: "go",
    icon: MonitorCog,
    menus: ["machine"],
    whyNot: (open, on) => (deviceOf(open, on) ? null : "commands.why.no_device"),
    run: (open, on) => {
      const device = deviceOf(open, on);
      if (device) showDevice(device.id);
    },
  }),
  command({
    id: "find_uses",
    group: "go",
    icon: SearchCheck,
    menus: ["machine"],
    whyNot: (open, on) => (deviceOf(open, on) ? null : "commands.why.no_device"),
    run: (open, on) => useUi.setState({ dialog: "find", find: deviceOf(open, on)?.id ?? "" }),
  }),
  command({
    id: "find",
    group: "go",
    icon: Search,
    keys: ["Ctrl+F"],
    menus: ["floor"],
    run: () => useUi.setState({ dialog: "find", find: "" }),
  }),
];
