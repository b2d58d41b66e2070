/** Menus: right click, long press, Menu key, over whatever is there. */
import i18next from "i18next";
import { toMetres } from "@/map/plane/projection";
import { keysOf, useKeymap } from "@/shell/keys/keymap";
import type { OpenProgram } from "../state/context";
import { useGestures, type MenuItem } from "../state/gestures";
import { onScreen, underPointer, type Under } from "../state/under";
import { select, useUi } from "../state/ui";
import { type Command, GROUPS, type MenuOf, type On, runCommand, selection } from "./command";

interface WindowPoint {
  readonly x: number;
  readonly y: number;
}

/** The commands of a menu that can be done now, group by group. */
export function itemsOf(commands: readonly Command[], menu: MenuOf, open: OpenProgram, on: On): MenuItem[] {
  const keymap = useKeymap.getState();
  return GROUPS.flatMap((group) => commands.filter((each) => each.group === group))
    .filter((each) => each.menus?.includes(menu) && each.whyNot(open, on) === null)
    .map((each) => ({
      id: each.id,
      label: i18next.t(each.words.name),
      icon: each.icon,
      group: each.group,
      keys: keysOf(each, keymap)[0],
      run: (now) => runCommand(now, each, on),
    }));
}

/** Which menu a press means, and what its commands are about; a step under it becomes the selected one. */
export function menuOver(under: Under): { readonly menu: MenuOf; readonly on: On } {
  if (under.step !== null) {
    if (!useUi.getState().selected.includes(under.step)) select([under.step]);
    return { menu: "step", on: { ...selection(), at: under.at } };
  }
  const on: On = { ...selection(), steps: [], zone: null, at: under.at };
  if (under.link)
    return { menu: "arrow", on: { ...on, link: under.link, steps: under.link.to ? [under.link.to] : [] } };
  return under.device === null ? { menu: "floor", on } : { menu: "machine", on: { ...on, device: under.device } };
}

export function showMenu(
  commands: readonly Command[],
  open: OpenProgram,
  { menu, on }: ReturnType<typeof menuOver>,
  at: WindowPoint,
): void {
  const items = itemsOf(commands, menu, open, on);
  if (items.length > 0) useGestures.setState({ menu: { at, label: labelOf(open, menu, on), items } });
}

function labelOf({ surroundings }: OpenProgram, menu: MenuOf, { device }: On): string {
  const name = surroundings.devices.get(device ?? "")?.name ?? "";
  return i18next.t(`commands.over.${menu}`, { name });
}

/** The menu of what has the keyboard: the step in a list, else the selected steps, else the place under the pointer. */
export function showMenuByKey(commands: readonly Command[], open: OpenProgram, target: EventTarget | null): boolean {
  const row = target instanceof Element ? target.closest("[data-step]") : null;
  const step = row?.getAttribute("data-step") ?? useUi.getState().selected.at(-1);
  const chip = open.scene.chips.get(step ?? "");
  const box = row?.getBoundingClientRect();
  if (chip) {
    const under = { step: chip.id, link: null, device: null, at: [0, 0] as const };
    showMenu(commands, open, menuOver(under), box ? { x: box.left + 24, y: box.bottom } : onScreen(toMetres(chip.at)));
    return true;
  }
  const at = midOfMap();
  const under = at ? underPointer(open, at) : null;
  if (at && under) showMenu(commands, open, menuOver(under), at);
  return under !== null;
}

function midOfMap(): WindowPoint | null {
  const box = document.querySelector("[data-map]")?.getBoundingClientRect();
  return box ? { x: box.left + box.width / 2, y: box.top + box.height / 3 } : null;
}
