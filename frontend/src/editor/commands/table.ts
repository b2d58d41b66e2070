/** All commands of the editor. A new one is a record in one of these lists; its words stand in `i18n/{en,de}/commands.json`. */
import { SquareMousePointer } from "lucide-react";
import { ARRANGE_COMMANDS } from "./arranging";
import { command, type Command } from "./command";
import { DRAW_COMMANDS } from "./drawing";
import { EDIT_COMMANDS } from "./editing";
import { GO_COMMANDS } from "./going";
import { showMenuByKey } from "./menu";
import { MACHINE_COMMANDS } from "./machine";
import { ORDER_COMMANDS } from "./order";
import { PROGRAM_COMMANDS } from "./program";
import { VIEW_COMMANDS } from "./view";

export const COMMANDS: readonly Command[] = [
  ...DRAW_COMMANDS,
  ...MACHINE_COMMANDS,
  ...EDIT_COMMANDS,
  ...ORDER_COMMANDS,
  ...ARRANGE_COMMANDS,
  ...VIEW_COMMANDS,
  ...GO_COMMANDS,
  ...PROGRAM_COMMANDS,
  command({
    id: "menu",
    group: "go",
    icon: SquareMousePointer,
    keys: ["Shift+F10", "ContextMenu"],
    fixed: true,
    onlyKeys: true,
    run: (open, { target }) => showMenuByKey(COMMANDS, open, target ?? null),
  }),
];

const BY_ID: ReadonlyMap<string, Command> = new Map(COMMANDS.map((each) => [each.id, each]));

export function commandOf(id: string): Command {
  const found = BY_ID.get(id);
  if (!found) throw new Error(`There is no command “${id}”. They stand in editor/commands/table.ts.`);
  return found;
}
