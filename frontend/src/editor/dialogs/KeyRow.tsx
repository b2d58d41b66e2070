/** One command in the list of keys: its name, its keys, and a button that waits for another one. */
import { Pencil, RotateCcw } from "lucide-react";
import { type KeyboardEvent, useState } from "react";
import { useTranslation } from "react-i18next";
import { IconButton } from "@/design/IconButton";
import { changeKeymap, keysOf, useKeymap } from "@/shell/keys/keymap";
import { HELD_KEYS, nameOfKeys, wordsOfKeys } from "@/shell/keys/keyNames";
import type { ShellCommand } from "@/shell/keys/shellCommands";
import { isTypable, takenBy } from "../commands/bindings";
import type { Command } from "../commands/command";
import classes from "./dialogs.module.css";

interface KeyRowProps {
  command: Command | ShellCommand;
  changing: boolean;
  onChanging: (changing: boolean) => void;
}

export function KeyRow({ command, changing, onChanging }: KeyRowProps) {
  const { t } = useTranslation();
  const keymap = useKeymap();
  const name = t(command.words.name);
  const keys = keysOf(command, keymap);
  const own = command.id in keymap.own;
  const remappable = "group" in command && !command.fixed ? command : null;
  return (
    <li className={classes.key}>
      <span>{name}</span>
      {changing && remappable ? (
        <NewKey command={remappable} onDone={() => onChanging(false)} />
      ) : (
        <span className={classes.keyList}>
          {keys.map((each) => (
            <kbd key={each}>{wordsOfKeys(each, (key) => t(`shell.keys.${key}`, key))}</kbd>
          ))}
          {keys.length === 0 ? <em>{t("commands.help.none")}</em> : null}
        </span>
      )}
      <span className={classes.keyButtons}>
        {own && remappable ? (
          <IconButton label={t("commands.help.reset", { name })} onClick={() => resetKeys(command.id)}>
            <RotateCcw size={14} aria-hidden="true" />
          </IconButton>
        ) : null}
        {remappable && !changing ? (
          <IconButton label={t("commands.help.change", { name })} onClick={() => onChanging(true)}>
            <Pencil size={14} aria-hidden="true" />
          </IconButton>
        ) : null}
      </span>
    </li>
  );
}

function resetKeys(id: string): void {
  const { own } = useKeymap.getState();
  changeKeymap({ own: Object.fromEntries(Object.entries(own).filter(([each]) => each !== id)) });
}

/** Waits for a key, and says why one cannot be had. */
function NewKey({ command, onDone }: { command: Command; onDone: () => void }) {
  const { t } = useTranslation();
  const [refused, setRefused] = useState<string | null>(null);
  const press = (event: KeyboardEvent) => {
    if (HELD_KEYS.includes(event.key) || event.key === "Tab") return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "Escape") return onDone();
    const keys = nameOfKeys(event.nativeEvent);
    const other = takenBy(command, keys, useKeymap.getState());
    const words = { key: wordsOfKeys(keys, (key) => t(`shell.keys.${key}`, key)), other: other && t(other.words.name) };
    if (other) return setRefused(t("commands.help.taken", words));
    if (!isTypable(keys)) return setRefused(t("commands.help.untypable"));
    changeKeymap({ own: { ...useKeymap.getState().own, [command.id]: [keys] } });
    return onDone();
  };
  return (
    <button
      type="button"
      className={classes.newKey}
      ref={(button) => button?.focus()}
      onKeyDown={press}
      onBlur={onDone}
      aria-live="polite"
    >
      {refused ?? t("commands.help.press")}
    </button>
  );
}
