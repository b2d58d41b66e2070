/** The constructs to draw with: a rail at the left, a bar at the bottom on small screens. */
import { Tooltip } from "@mantine/core";
import { Hand, Lock, MousePointer2 } from "lucide-react";
import type { ReactNode } from "react";
import { VipoIcon } from "@/design/VipoIcon";
import type { Family } from "@/program/kinds";
import { TOOLS } from "../state/tools";
import { useOpenProgram } from "../state/context";
import { takeTool } from "../state/tool";
import { useUi } from "../state/ui";
import { MoreTools } from "./MoreTools";
import classes from "./rail.module.css";

const COMMON = TOOLS.filter((kind) => !kind.rare);

export function ToolRail() {
  const { t, canEdit } = useOpenProgram();
  return (
    <div className={classes.rail} role="toolbar" aria-label={t("rail")} aria-orientation="vertical">
      <Tool tool="select" letter="V" label={t("tool.select")}>
        <MousePointer2 size={18} aria-hidden="true" />
      </Tool>
      <Tool tool="pan" letter="H" label={t("tool.pan")}>
        <Hand size={18} aria-hidden="true" />
      </Tool>
      {canEdit
        ? COMMON.map((kind, index) => (
            <FamilyGap key={kind.kind} first={COMMON[index - 1]?.family !== kind.family}>
              <Tool tool={kind.kind} letter={kind.key} label={t(`kind.${kind.kind}`)} family={kind.family}>
                <VipoIcon name={kind.icon} size={18} />
              </Tool>
            </FamilyGap>
          ))
        : null}
      {canEdit ? (
        <FamilyGap first>
          <MoreTools />
        </FamilyGap>
      ) : null}
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

function Tool({
  tool,
  letter,
  label,
  family,
  children,
}: {
  tool: string;
  letter: string;
  label: string;
  family?: Family;
  children: ReactNode;
}) {
  const active = useUi((ui) => ui.gesture.tool === tool);
  const locked = useUi((ui) => ui.gesture.tool === tool && ui.gesture.locked);
  const take = () => useUi.setState((ui) => ({ gesture: takeTool(ui.gesture, tool, false) }));
  return (
    <Tooltip label={`${label} · ${letter}`} position="right">
      <button
        type="button"
        className={classes.tool}
        style={family ? { color: `var(--${family})` } : undefined}
        aria-label={label}
        aria-pressed={active}
        aria-keyshortcuts={letter}
        onClick={take}
      >
        {children}
        <kbd aria-hidden="true">{letter}</kbd>
        {locked ? <Lock size={10} className={classes.lock} aria-hidden="true" /> : null}
      </button>
    </Tooltip>
  );
}
