/** The program itself, while no step is selected: its parameters, its robots, its variables and zones. */
import { ArrowRight, X } from "lucide-react";
import { lazy, Suspense, useEffect, useRef } from "react";
import { IconButton } from "@/design/IconButton";
import { VipoIcon } from "@/design/VipoIcon";
import { namesSet } from "../edits/variables";
import { changeProgramParameter } from "../edits/names";
import { zoneIcon } from "@/program/canvas/Zones";
import { unitSign } from "@/i18n/units";
import { makeId } from "../state/actions";
import { useOpenProgram } from "../state/context";
import { isTyping } from "../state/focus";
import { hideProgram, select, useUi } from "../state/ui";
import { selectZone } from "../state/gestures";
import { AddParameter } from "./fields/AddParameter";
import classes from "../panel.module.css";
import { FormBody } from "../canvas/FormBody";
import { RolesSection } from "./RolesSection";
import { Section } from "./fields/FieldFrame";

/** Loaded with the first parameter. */
const ParameterCard = lazy(async () => ({ default: (await import("./fields/ParameterCard")).ParameterCard }));

export function ProgramPanel() {
  const { t, program } = useOpenProgram();
  const panel = useFocusedSheet();
  return (
    <aside ref={panel} className={classes.panel} aria-label={t("program.label")} tabIndex={-1}>
      <header className={classes.head}>
        <span className={classes.title}>
          <h2>{t("program.label")}</h2>
          <span>{program.name}</span>
        </span>
        <IconButton label={t("inspector.close")} onClick={hideProgram}>
          <X size={17} aria-hidden="true" />
        </IconButton>
      </header>
      <FormBody>
        <Parameters />
        <hr className={classes.line} />
        <RolesSection />
        <hr className={classes.line} />
        <Variables />
        <Zones />
      </FormBody>
    </aside>
  );
}

/** A panel that was asked for takes the focus; Escape puts it away. */
function useFocusedSheet() {
  const panel = useRef<HTMLElement>(null);
  const asked = useUi((ui) => ui.programSheet);
  useEffect(() => {
    if (asked) panel.current?.focus();
  }, [asked]);
  useEffect(() => {
    const box = panel.current;
    const press = (event: KeyboardEvent) => {
      if (event.key !== "Escape" || isTyping(event.target)) return; // a field is left first

      event.preventDefault();
      hideProgram();
    };
    box?.addEventListener("keydown", press);
    return () => box?.removeEventListener("keydown", press);
  }, []);
  return panel;
}

function Parameters() {
  const { t, document, apply, canEdit } = useOpenProgram();
  const parameters = Object.entries(document.parameters);
  return (
    <Section title={t("program.parameters")} note={t("program.parameters_note")}>
      <Suspense fallback={null}>
        {parameters.map(([id, parameter]) => (
          <ParameterCard
            key={id}
            parameter={parameter}
            disabled={!canEdit}
            onChange={(next) => apply(changeProgramParameter(document, id, next))}
            onRemove={() => apply([{ do: "set_parameter", id, value: null }])}
          />
        ))}
      </Suspense>
      <AddParameter
        taken={Object.values(document.parameters)}
        disabled={!canEdit}
        onAdd={(value) => apply([{ do: "set_parameter", id: makeId(), value }])}
      />
    </Section>
  );
}

/** Variables need no declaration: what is set anywhere is listed with the steps that set it. */
function Variables() {
  const { t, document, compiled } = useOpenProgram();
  const names = namesSet(document, null);
  if (names.length === 0) return null;
  const setters = (name: string) =>
    Object.entries(document.steps)
      .filter(([, step]) => step.params.variable === name || step.params.result === name)
      .map(([id]) => id);
  return (
    <Section title={t("program.variables")}>
      <ul className={classes.names}>
        {names.map((each) => (
          <li key={each.name}>
            <code>{each.name}</code>
            <span className={classes.grow}>
              {[t(`type.${each.type}`), unitSign(each.unit)].filter(Boolean).join(", ")}
            </span>
            {setters(each.name).map((id) => (
              <button
                key={id}
                type="button"
                aria-label={goLabel(t, compiled?.numbers[id])}
                onClick={() => select([id])}
              >
                {compiled?.numbers[id] ?? "–"}
              </button>
            ))}
          </li>
        ))}
      </ul>
    </Section>
  );
}

function goLabel(t: (key: string, values?: Record<string, unknown>) => string, number: string | undefined): string {
  return t("inspector.step", { number: number ?? "–" });
}

function Zones() {
  const { t, document } = useOpenProgram();
  const zones = Object.entries(document.zones);
  if (zones.length === 0) return null;
  return (
    <Section title={t("program.zones")}>
      <ul className={classes.names}>
        {zones.map(([id, zone]) => (
          <li key={id}>
            <span style={{ color: "var(--note)", display: "inline-flex" }}>
              <VipoIcon name={zoneIcon(zone)} size={16} />
            </span>
            <span className={classes.grow}>{zone.name}</span>
            <span>{t(`zone_rule.${zone.rule}`)}</span>
            <button type="button" aria-label={zone.name} onClick={() => selectZone(id)}>
              <ArrowRight size={14} aria-hidden="true" />
            </button>
          </li>
        ))}
      </ul>
    </Section>
  );
}
