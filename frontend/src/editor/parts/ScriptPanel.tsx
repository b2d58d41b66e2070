/** The task script beside the drawing: each line knows its step, and what is typed changes the drawing. */
import { useEffect, useId, useMemo, useRef, useState, useSyncExternalStore } from "react";
import i18next from "i18next";
import { completeScript } from "../script/completion";
import type { LineMessage, ScriptContent } from "../script/decorations";
import type { ScriptView } from "../script/scriptView";
import type { ScriptProblem, ScriptSession, ScriptState } from "../script/session";
import { sameLines } from "../script/textMerge";
import { useScriptSession } from "../script/useScriptSession";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { select, useUi } from "../state/ui";
import classes from "./drawer.module.css";

export function ScriptPanel() {
  const { compiled, t } = useOpenProgram();
  const session = useScriptSession();
  const behind = useBehind();
  const ready = compiled?.script && session;
  if (!ready) return <p className={classes.nothing}>{t(behind ? "script.behind" : "script.none")}</p>;
  return <ScriptText session={session} />;
}

function ScriptText({ session }: { session: ScriptSession }) {
  const open = useOpenProgram();
  const { canEdit, t } = open;
  const state = useSyncExternalStore(session.subscribe, session.getState);
  const selected = useUi((ui) => ui.selected);
  const place = useRef<HTMLDivElement>(null);
  const [view, setView] = useState<ScriptView | null>(null);
  /** The editor of scripts could not be loaded: the script can be read. */
  const [without, setWithout] = useState(false);
  const devices = useRef(open.devices);
  const telling = useId();
  const label = t("drawer.script");
  useEffect(() => {
    devices.current = open.devices;
  }, [open.devices]);
  useEffect(() => {
    let opened: ScriptView | undefined;
    const closing = new AbortController();
    void import("../script/scriptView").then(
      ({ openScript }) => {
        if (!place.current || closing.signal.aborted) return;
        opened = openScript(place.current, label, canEdit, {
          onStep: (step) => select([step]),
          onType: (text) => session.type(text),
          onFocus: (focused) => session.focus(focused),
          onLeave: () => document.getElementById("drawer-tab-script")?.focus(),
          complete: completeScript(() => devices.current),
        });
        setView(opened);
      },
      () => setWithout(true),
    );
    return () => {
      closing.abort();
      setView(null);
      session.focus(false);
      opened?.destroy();
    };
  }, [label, canEdit, session]);
  const content = useMemo(() => contentOf(open, state, selected, telling), [open, state, selected, telling]);
  useEffect(() => view?.show(content), [view, content]);
  return (
    <div className={classes.scriptPanel}>
      <div ref={place} className={classes.script}>
        {without ? <pre aria-label={label}>{state.text}</pre> : null}
      </div>
      <ScriptStrip state={state} session={session} id={telling} />
    </div>
  );
}

/** Nobody compiles what the server does not have: what is shown is from before one's last changes, or missing. */
function useBehind(): boolean {
  const { shared, compiled } = useOpenProgram();
  const { connection, waiting, notTaken, late } = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  if (connection === "live" || connection === "connecting") return notTaken > 0 || late;
  return waiting > 0 || compiled === null;
}

function ScriptStrip({ state, session, id }: { state: ScriptState; session: ScriptSession; id: string }) {
  const { t } = useOpenProgram();
  const { problems, conflicts, failed } = state;
  const [first] = problems;
  const [met] = conflicts;
  const invalid = first !== undefined || failed !== null;
  const behind = useBehind();
  return (
    <div role="status" id={id} className={classes.scriptStrip} data-shown={invalid || met || behind ? true : undefined}>
      {behind ? <p>{t("script.behind")}</p> : null}
      {invalid ? (
        <p>
          <strong>{t("script.invalid")}</strong> {failed ?? (first ? inWords(first) : "")}
        </p>
      ) : null}
      {met ? <p>{t("script.met", { line: met.line, text: met.theirs.join(" ").trim() })}</p> : null}
      {invalid ? (
        <button type="button" className={classes.scriptDiscard} onClick={() => session.discard()}>
          {t("script.discard")}
        </button>
      ) : null}
    </div>
  );
}

function inWords(problem: ScriptProblem): string {
  return problem.messages?.[i18next.resolvedLanguage ?? "en"] ?? problem.message;
}

function hintOf(problem: ScriptProblem): string {
  return problem.hints?.[i18next.resolvedLanguage ?? "en"] ?? problem.expected;
}

function contentOf(
  { compiled, diagnostics }: OpenProgram,
  { text, own, problems, conflicts }: ScriptState,
  selected: readonly string[],
  telling: string,
): ScriptContent {
  const printed = compiled?.script ?? "";
  const places = own ? sameLines(printed, text) : null;
  const lines = compiled?.lines ?? [];
  const line = (number: number) => (places ? places.indexOf(number - 1) + 1 : number);
  const checks = diagnostics.flatMap(({ line: at, message: said, severity }): LineMessage[] =>
    at && line(at) > 0 ? [{ line: line(at), text: said, severity }] : [],
  );
  const refusals = problems.map((each): LineMessage => ({ line: each.line, text: hintOf(each), severity: "error" }));
  return {
    text,
    lines: places ? places.map((at) => lines[at] ?? "") : lines,
    numbers: compiled?.numbers ?? {},
    messages: problems.length > 0 ? refusals : checks,
    underlines: problems.map((each) => ({
      line: each.line,
      column: each.column,
      endLine: each.end_line,
      endColumn: each.end_column,
      text: inWords(each),
    })),
    conflicts,
    selected: new Set(selected),
    scrollTo: selected.at(-1) ?? null,
    describedBy: problems.length > 0 ? telling : null,
  };
}
