/** The constructs to draw with: a rail at the left, a bar at the bottom on small screens. */
import { Tooltip } from "@mantine/core";
import { Lock } from "lucide-react";
import { createPortal } from "react-dom";
import { useTranslation } from "react-i18next";
import { memo, type PointerEvent, type ReactNode } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import type { Family } from "@/program/kinds";
import { ariaKeys } from "@/shell/keys/keyNames";
import { keysOf, useKeymap } from "@/shell/keys/keymap";
import { toolId } from "../commands/drawing";
import type { Command } from "../commands/command";
import { commandOf } from "../commands/table";
import { TOOLS } from "../state/tools";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { MoreTools } from "./MoreTools";
import { type DraggedTool, useToolDrag } from "./toolDrag";
import classes from "./rail.module.css";

const COMMON = TOOLS.filter((kind) => !kind.rare);

export function ToolRail() {
  const open = useOpenProgram();
  const { t, canEdit } = open;
  const { dragged, ...hand } = useToolDrag(open);
  return (
    <div className={classes.rail} role="toolbar" aria-label={t("rail")} aria-orientation="vertical">
      <Tool tool="select" command="select" run={hand.run} />
      <Tool tool="pan" command="pan" run={hand.run} />
      {canEdit
        ? COMMON.map((kind, index) => (
            <FamilyGap key={kind.kind} first={COMMON[index - 1]?.family !== kind.family}>
              <Tool tool={kind.kind} command={toolId(kind.kind)} family={kind.family} {...hand} />
            </FamilyGap>
          ))
        : null}
      {canEdit ? (
        <FamilyGap first>
          <MoreTools />
        </FamilyGap>
      ) : null}
      {dragged ? createPortal(<Dragged {...dragged} />, document.body) : null}
    </div>
  );
}

function FamilyGap({ first, children }: { first: boolean; children: ReactNode }) {
  return (
    <>
      {first ? <span className={classes.line} aria-hidden="true" /> : null}
      {children}
    </>
  );
}

interface ToolProps {
  tool: string;
  command: string;
  family?: Family;
  run: (command: Command) => unknown;
  begin?: (tool: string, event: PointerEvent) => void;
  wasDragged?: () => boolean;
}

/** Drawn anew when it changes itself: the program changes with each step of anybody, and there are twenty of these. */
const Tool = memo(function Tool({ tool, command: id, family, run, begin, wasDragged }: ToolProps) {
  const { t } = useTranslation();
  const command = commandOf(id);
  const keys = useKeymap((keymap) => keysOf(command, keymap)[0]);
  const active = useUi((ui) => ui.gesture.tool === tool);
  const locked = useUi((ui) => ui.gesture.tool === tool && ui.gesture.locked);
  const { icon: Icon } = command;
  const name = t(command.words.name);
  const label = [name, keys, locked ? t("commands.tool_kept") : ""].filter(Boolean).join(" · ");
  return (
    <Tooltip label={label} position="right">
      <button
        type="button"
        className={classes.tool}
        style={family ? { color: `var(--${family})` } : undefined}
        aria-label={locked ? `${name}, ${t("commands.tool_kept")}` : name}
        aria-pressed={active}
        aria-keyshortcuts={keys ? ariaKeys([keys]) : undefined}
        onPointerDown={(event) => begin?.(tool, event)}
        onClick={() => (wasDragged?.() ? undefined : run(command))}
      >
        <Icon size={18} />
        {keys && keys.length === 1 ? <kbd aria-hidden="true">{keys}</kbd> : null}
        {locked ? <Lock size={10} className={classes.lock} aria-hidden="true" /> : null}
      </button>
    </Tooltip>
  );
});

/** What hangs on the pointer. */
function Dragged({ kind, x, y }: DraggedTool) {
  const tool = TOOLS.find((each) => each.kind === kind);
  return (
    <span className={classes.dragged} style={{ left: x, top: y, color: `var(--${tool?.family ?? "text"})` }}>
      <VipoIcon name={tool?.icon ?? ""} size={20} />
    </span>
  );
}
