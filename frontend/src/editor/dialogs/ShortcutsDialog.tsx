/** The list of all keys, made from the commands themselves; people can give commands other keys. */
import { Button, Modal, Switch, TextInput } from "@mantine/core";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { changeKeymap, keysOf, useKeymap } from "@/shell/keys/keymap";
import { SHELL_COMMANDS, type ShellCommand } from "@/shell/keys/shellCommands";
import { GROUPS, type Command, type Group } from "../commands/command";
import { COMMANDS } from "../commands/table";
import { useUi } from "../state/ui";
import { KeyRow } from "./KeyRow";
import classes from "./dialogs.module.css";

export function ShortcutsDialog() {
  const { t } = useTranslation();
  const opened = useUi((ui) => ui.dialog === "shortcuts");
  const close = () => useUi.setState({ dialog: null });
  return (
    <Modal opened={opened} onClose={close} closeOnClickOutside title={t("editor.keys.title")} size={620}>
      {opened ? <Sheet /> : null}
    </Modal>
  );
}

function Sheet() {
  const { t } = useTranslation();
  const [search, setSearch] = useState("");
  const keymap = useKeymap();
  /** The command that waits for a key. */
  const [changing, setChanging] = useState<string | null>(null);
  const wanted = search.trim().toLowerCase();
  const found = [...COMMANDS, ...SHELL_COMMANDS].filter((each) =>
    `${t(each.words.name)} ${keysOf(each, keymap).join(" ")}`.toLowerCase().includes(wanted),
  );
  const changed = Object.keys(keymap.own).length > 0;
  return (
    <div className={classes.content}>
      <Switch
        label={t("commands.help.letters")}
        description={t("commands.help.letters_note")}
        checked={keymap.characters}
        onChange={(event) => changeKeymap({ characters: event.currentTarget.checked })}
      />
      <TextInput
        aria-label={t("commands.help.search")}
        placeholder={t("commands.help.search")}
        value={search}
        onChange={(event) => setSearch(event.currentTarget.value)}
      />
      {GROUPS.map((group) => (
        <Part
          key={group}
          group={group}
          commands={found.filter((each) => groupOf(each) === group)}
          changing={changing}
          onChanging={setChanging}
        />
      ))}
      {found.length === 0 ? <p>{t("commands.help.nothing")}</p> : null}
      {changed ? (
        <Button variant="default" onClick={() => changeKeymap({ own: {} })}>
          {t("commands.help.reset_all")}
        </Button>
      ) : null}
    </div>
  );
}

function groupOf(command: Command | ShellCommand): Group {
  return "group" in command ? command.group : "go";
}

interface PartProps {
  group: Group;
  commands: readonly (Command | ShellCommand)[];
  changing: string | null;
  onChanging: (id: string | null) => void;
}

function Part({ group, commands, changing, onChanging }: PartProps) {
  const { t } = useTranslation();
  if (commands.length === 0) return null;
  return (
    <section aria-label={t(`commands.group.${group}`)}>
      <h3 className={classes.keysTitle}>{t(`commands.group.${group}`)}</h3>
      <ul className={classes.keys}>
        {commands.map((each) => (
          <KeyRow
            key={each.id}
            command={each}
            changing={changing === each.id}
            onChanging={(now) => onChanging(now ? each.id : null)}
          />
        ))}
      </ul>
    </section>
  );
}
