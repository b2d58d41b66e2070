/** The task script beside the drawing: each line knows its step, and the other way round. */
import { useEffect, useRef } from "react";
import { useOpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import classes from "./drawer.module.css";
import { openScript, type ScriptView } from "./scriptView";

export function ScriptPanel() {
  const { compiled, t } = useOpenProgram();
  return compiled?.script ? <ScriptText /> : <p className={classes.nothing}>{t("script.none")}</p>;
}

function ScriptText() {
  const { compiled, diagnostics, t } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const place = useRef<HTMLDivElement>(null);
  const view = useRef<ScriptView | null>(null);
  const label = t("drawer.script");
  useEffect(() => {
    if (!place.current) return;
    const opened = openScript(place.current, label, (step) => select([step]));
    view.current = opened;
    return () => {
      opened.destroy();
      view.current = null;
    };
  }, [label]);
  useEffect(() => {
    if (compiled)
      view.current?.show({
        script: compiled.script,
        lines: compiled.lines,
        numbers: compiled.numbers,
        diagnostics,
        selected: new Set(selected),
        scrollTo: selected.at(-1) ?? null,
      });
  }, [compiled, diagnostics, selected, label]);
  return <div ref={place} className={classes.script} />;
}
