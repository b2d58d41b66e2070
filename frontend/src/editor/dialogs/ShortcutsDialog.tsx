/** The list of keys. */
import { Modal } from "@mantine/core";
import { COMMANDS } from "../gestures/commands";
import { TOOLS } from "../state/tools";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./dialogs.module.css";

const KEYS: readonly [string, string][] = [
  ["V · H", "select"],
  [".", "more"],
  ["Enter", "enter"],
  ["B · Shift+B", "branch"],
  ["X · D · Q", "modes"],
  ["Ctrl+Z · Ctrl+Shift+Z", "undo"],
  ["Ctrl+C · X · V · D", "copy"],
  ["Ctrl+A", "all"],
  ["Ctrl+G", "function"],
  ["← → ↑ ↓", "neighbour"],
  ["Alt+← → ↑ ↓", "nudge"],
  ["Delete", "delete"],
  ["F8 · Shift+F8", "problem"],
  ["Ctrl+J", "drawer"],
  ["Ctrl+Enter", "run"],
  ["Ctrl+Shift+.", "stop"],
  ["Esc", "back"],
];

/** What the list above has in its own words is not said twice. */
const GESTURES = COMMANDS.filter((command) => command.keys.includes("Arrow") || /Shift/.test(command.keys));

export function ShortcutsDialog() {
  const { t } = useOpenProgram();
  const opened = useUi((ui) => ui.dialog === "shortcuts");
  return (
    <Modal opened={opened} onClose={() => useUi.setState({ dialog: null })} closeOnClickOutside title={t("keys.title")}>
      <dl className={classes.keys}>
        {TOOLS.filter((kind) => kind.key).map((kind) => [
          <dt key={`${kind.kind}-key`}>{kind.key}</dt>,
          <dd key={kind.kind}>{t(`kind.${kind.kind}`)}</dd>,
        ])}
        <dt>Shift+F10</dt>
        <dd>{t("gesture.menu")}</dd>
        {GESTURES.map(({ id, keys }) => [
          <dt key={`${id}-key`}>{keys.replace("Arrow", "")}</dt>,
          <dd key={id}>{t(`gesture.command.${id}`)}</dd>,
        ])}
        {KEYS.map(([key, what]) => [<dt key={`${what}-key`}>{key}</dt>, <dd key={what}>{t(`keys.${what}`)}</dd>])}
      </dl>
    </Modal>
  );
}
