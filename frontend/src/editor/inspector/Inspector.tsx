/** The inspector: the selected step's values, each with its problems under it. */
import { CircleAlert, Copy, Trash2, X } from "lucide-react";
import { lazy, Suspense, useMemo } from "react";
import { Avatar } from "@/design/Avatar";
import { loadScreenTexts } from "@/i18n";
import { IconButton } from "@/design/IconButton";
import { VipoIcon } from "@/design/VipoIcon";
import { useGestures } from "../state/gestures";
import { knownNames } from "../edits/variables";
import { kindOf } from "@/program/kinds";
import { duplicateSelected, removeSelected } from "../state/actions";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import { doAndSay } from "../state/undoing";
import { FormBody } from "../canvas/FormBody";
import classes from "../panel.module.css";
import { StepEditorContext, useStepEditor, type StepEditor } from "./fields/stepEditor";

/** The forms of steps are loaded when the first step is looked at, or once the program is on the screen. */
const loadStepForm = () => import("./forms/StepForm");
const loadDevicePanel = async () => (await Promise.all([import("./DevicePanel"), loadScreenTexts()]))[0];
const loadSeveral = () => import("./Several");
const loadProgramPanel = () => import("./ProgramPanel");
const DevicePanel = lazy(async () => ({ default: (await loadDevicePanel()).DevicePanel }));
const Several = lazy(async () => ({ default: (await loadSeveral()).Several }));
const ProgramPanel = lazy(async () => ({ default: (await loadProgramPanel()).ProgramPanel }));
/** Fetch what the inspector shows, so that it opens at once. */
export const loadPanels = () => Promise.all([loadStepForm(), loadDevicePanel(), loadSeveral()]);
const StepForm = lazy(async () => ({ default: (await loadStepForm()).StepForm }));

export function Inspector() {
  const { document } = useOpenProgram();
  const selected = useUi((ui) => ui.selected);
  const zone = useGestures((ui) => ui.zone);
  const device = useUi((ui) => ui.device);
  const id = selected.at(-1);
  const step = id ? document.steps[id] : undefined;
  if (selected.length > 1)
    return (
      <Suspense fallback={null}>
        <Several />
      </Suspense>
    );
  if (id && step) return <One key={id} id={id} />;
  if (device !== null)
    return (
      <Suspense fallback={null}>
        <DevicePanel key={device} id={device} />
      </Suspense>
    );
  if (zone !== null) return null;
  return (
    <Suspense fallback={null}>
      <ProgramPanel />
    </Suspense>
  );
}

function One({ id }: { id: string }) {
  const { document, apply, canEdit, shared } = useOpenProgram();
  const step = document.steps[id];
  const editor = useMemo<StepEditor | null>(() => {
    if (!step) return null;
    return {
      id,
      step,
      parameters: knownNames(document, id),
      disabled: !canEdit,
      set: (name, value) => apply([{ do: "set_param", id, name, value }]),
      showEditing: (editing) => shared.awareness.setLocalStateField("editing", editing ? id : null),
    };
  }, [document, id, step, canEdit, apply, shared]);
  if (!editor) return null;
  return (
    <StepEditorContext value={editor}>
      <StepPanel />
    </StepEditorContext>
  );
}

function homeless(kind: string): string {
  return kind === "comment" ? "about.comment" : "steps.draft";
}

function StepPanel() {
  const { t, compiled, document } = useOpenProgram();
  const { id, step } = useStepEditor();
  const kind = kindOf(step.kind);
  const number = compiled?.numbers[id];
  const parent = step.place ? document.steps[step.place[0]] : undefined;
  const where = parent ? t("inspector.inside", { kind: t(`kind.${parent.kind}`) }) : "";
  return (
    <aside className={classes.panel} aria-label={t("inspector.label")}>
      <header className={classes.head}>
        <span
          className={classes.icon}
          style={{ color: `var(--${kind.family})`, background: `var(--${kind.family}-soft)` }}
        >
          <VipoIcon name={kind.icon} size={20} />
        </span>
        <span className={classes.title}>
          <h2>{t(`kind.${step.kind}`)}</h2>
          <span>
            {step.place ? `${t("inspector.step", { number: number ?? "…" })}${where}` : t(homeless(step.kind))}
          </span>
        </span>
        <IconButton label={t("inspector.close")} onClick={() => useUi.setState({ inspector: false })}>
          <X size={17} aria-hidden="true" />
        </IconButton>
      </header>
      <FormBody>
        <Summary />
        <Editing />
        <Suspense fallback={null}>
          <StepForm kind={step.kind} />
        </Suspense>
      </FormBody>
      <Footer />
    </aside>
  );
}

/** "1 field needs a value". */
function Summary() {
  const { diagnostics, t } = useOpenProgram();
  const { id } = useStepEditor();
  const errors = diagnostics.filter((each) => each.step === id && each.severity === "error");
  if (errors.length === 0) return null;
  return (
    <div className={classes.summary} role="status">
      <CircleAlert size={16} aria-hidden="true" />
      <span>
        <strong>{t("inspector.problems", { count: errors.length })}</strong>
        {t("inspector.then_run")}
      </span>
    </div>
  );
}

/** Who else is in this step now; nobody is locked out. */
function Editing() {
  const { people, t } = useOpenProgram();
  const { id } = useStepEditor();
  const others = people.filter((person) => !person.me && (person.editing === id || person.selection.includes(id)));
  return others.map((person) => (
    <p key={person.client} className={classes.other}>
      <Avatar name={person.name} initials={person.initials} colour={person.colour} size={20} />
      {t(person.editing === id ? "inspector.edits_too" : "inspector.looks_too", { name: person.name })}
    </p>
  ));
}

function Footer() {
  const open = useOpenProgram();
  const { t, canEdit, document, apply, people } = open;
  const me = people.find((person) => person.me);
  return (
    <footer className={classes.foot}>
      {me ? <Avatar name={me.name} initials={me.initials} colour={me.colour} size={22} /> : null}
      <span>{t(canEdit ? "inspector.you_edit" : "inspector.you_look")}</span>
      {canEdit ? (
        <>
          <IconButton label={t("duplicate")} onClick={() => duplicateSelected(document, apply)}>
            <Copy size={16} aria-hidden="true" />
          </IconButton>
          <IconButton
            label={t("delete")}
            className={classes.delete}
            onClick={() =>
              doAndSay(
                open,
                () => removeSelected(document, apply),
                (count) => t("removed", { count }),
              )
            }
          >
            <Trash2 size={16} aria-hidden="true" />
          </IconButton>
        </>
      ) : null}
    </footer>
  );
}
