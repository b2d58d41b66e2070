/** All constructs by name, the rare ones first; what the rail has no room for is taken from here. */
import { Popover, Tooltip } from "@mantine/core";
import { Ellipsis } from "lucide-react";
import { useLayoutEffect, useRef, useState, type KeyboardEvent } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import type { Kind } from "@/program/kinds";
import { ariaKeys } from "@/shell/keys/keyNames";
import { keysOf, useKeymap } from "@/shell/keys/keymap";
import { rowPress } from "@/shell/palette/rowPress";
import { toolId } from "../commands/drawing";
import { runCommand } from "../commands/keys";
import { selection } from "../commands/command";
import { commandOf } from "../commands/table";
import { TOOLS } from "../state/tools";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./rail.module.css";

const RARE_FIRST = [...TOOLS].sort((one, other) => Number(other.rare ?? false) - Number(one.rare ?? false));

export function MoreTools() {
  const { t } = useOpenProgram();
  const opened = useUi((ui) => ui.more);
  const key = useKeyOf("more");
  const rareTool = useUi((ui) => TOOLS.some((kind) => kind.rare && kind.kind === ui.gesture.tool));
  const show = (more: boolean) => useUi.setState({ more });
  return (
    <Popover
      opened={opened}
      onChange={show}
      position="right-end"
      offset={14}
      trapFocus
      returnFocus
      shadow="md"
      // It is there at once: what is typed right after its key must not choose tools.
      transitionProps={{ duration: 0 }}
    >
      <Popover.Target>
        <Tooltip label={[t("more.label"), key].filter(Boolean).join(" · ")} position="right" disabled={opened}>
          <button
            type="button"
            className={`${classes.tool} ${classes.all}`}
            aria-label={t("more.label")}
            aria-expanded={opened}
            aria-pressed={rareTool}
            aria-keyshortcuts={key ? ariaKeys([key]) : undefined}
            onClick={() => show(!opened)}
          >
            <Ellipsis size={18} aria-hidden="true" />
          </button>
        </Tooltip>
      </Popover.Target>
      <Popover.Dropdown p={0} className={classes.dropdown} aria-label={t("more.label")}>
        <Search onDone={() => show(false)} />
      </Popover.Dropdown>
    </Popover>
  );
}

/** The first key of a command, as this person has it. */
function useKeyOf(id: string): string | undefined {
  return useKeymap((keymap) => keysOf(commandOf(id), keymap)[0]);
}

/** Those whose name, sentence or other words hold the text. */
function toolsWith(text: string, t: (key: string) => string): readonly Kind[] {
  const wanted = text.trim().toLowerCase();
  const said = (kind: string) => ["kind", "about", "also"].map((part) => t(`${part}.${kind}`)).join(" ");
  return RARE_FIRST.filter(({ kind }) => said(kind).toLowerCase().includes(wanted));
}

function Search({ onDone }: { onDone: () => void }) {
  const open = useOpenProgram();
  const { t } = open;
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const field = useRef<HTMLInputElement>(null);
  useLayoutEffect(() => field.current?.focus({ preventScroll: true }), []);
  const found = toolsWith(text, t);
  const take = (kind: Kind | undefined, byKeyboard: boolean) => {
    if (!kind) return;
    runCommand(open, commandOf(toolId(kind.kind)), { ...selection(), keys: byKeyboard ? "Enter" : undefined });
    onDone();
  };
  const press = (event: KeyboardEvent) => {
    if (event.key === "Enter") take(found[at], true);
    else if (event.key === "ArrowDown") setAt(Math.min(found.length - 1, at + 1));
    else if (event.key === "ArrowUp") setAt(Math.max(0, at - 1));
    else return;
    event.preventDefault();
  };
  return (
    <div className={classes.more}>
      <input
        ref={field}
        value={text}
        role="combobox"
        aria-expanded="true"
        aria-controls="more-tools"
        aria-activedescendant={found[at] ? `more-${found[at].kind}` : undefined}
        aria-label={t("more.search")}
        placeholder={t("more.search")}
        data-autofocus
        onChange={(event) => {
          setText(event.target.value);
          setAt(0);
        }}
        onKeyDown={press}
      />
      <ul id="more-tools" role="listbox" aria-label={t("more.label")}>
        {found.map((kind, index) => (
          <Row key={kind.kind} kind={kind} chosen={index === at} onTake={() => take(kind, false)} />
        ))}
        {found.length === 0 ? <li className={classes.none}>{t("more.none")}</li> : null}
      </ul>
    </div>
  );
}

function Row({ kind, chosen, onTake }: { kind: Kind; chosen: boolean; onTake: () => void }) {
  const { t } = useOpenProgram();
  const key = useKeyOf(toolId(kind.kind));
  return (
    <li
      id={`more-${kind.kind}`}
      role="option"
      aria-selected={chosen}
      ref={(row) => {
        if (chosen) row?.scrollIntoView({ block: "nearest" });
      }}
      {...rowPress(onTake)}
    >
      <span style={{ color: `var(--${kind.family})` }}>
        <VipoIcon name={kind.icon} size={18} />
      </span>
      <span className={classes.what}>
        <strong>{t(`kind.${kind.kind}`)}</strong>
        <span>{t(`about.${kind.kind}`)}</span>
      </span>
      {key ? <kbd>{key}</kbd> : null}
    </li>
  );
}
