/** What a Try catches: its catches in the order in which they are tried, and whether it does something at last. */
import { Button, Checkbox, Switch } from "@mantine/core";
import { Minus, Plus } from "lucide-react";
import { useId, useRef } from "react";
import { addedCatch, catchesOf, kindsOf, removedCatch } from "@/program/document/catches";
import { fieldsOf } from "@/program/kinds";
import { useOpenProgram } from "../../state/context";
import type { Person } from "../../state/presence";
import classes from "../../panel.module.css";
import { FieldFrame } from "../fields/FieldFrame";
import { useStepEditor } from "../fields/stepEditor";

const KINDS = fieldsOf("try").find((field) => field.name === "kinds")?.choices ?? [];

export function TryForm() {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const inside = (branch: string) => scene.tree.children(id, branch).length > 0;
  const final = step.params.finally === true || inside("finally");
  return (
    <>
      <Catches />
      <hr className={classes.line} />
      <Switch
        label={t("try.finally")}
        description={t(inside("finally") ? "try.empty_first" : "try.finally_means")}
        checked={final}
        disabled={disabled || inside("finally")}
        onChange={(event) => set("finally", event.currentTarget.checked || null)}
      />
    </>
  );
}

/** The keyboard goes on in a catch that was added, and at the button that adds one when a catch is gone. */
function Catches() {
  const { t, people } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const add = useRef<HTMLButtonElement>(null);
  const list = useRef<HTMLDivElement>(null);
  const there = catchesOf(step.params);
  const added = addedCatch(step.params, turnAt(people, id));
  const several = there.length > 1;
  const addOne = () => {
    if (!added) return;
    set(...added);
    requestAnimationFrame(() =>
      [...(list.current?.querySelectorAll<HTMLElement>("[data-catch]") ?? [])]
        .find((each) => kindsOf(each.dataset.catch ?? "") === added[0] || each.dataset.catch === added[0])
        ?.querySelector("input")
        ?.focus(),
    );
  };
  const remove = (branch: string) => {
    set(...removedCatch(branch));
    requestAnimationFrame(() => add.current?.focus());
  };
  return (
    <div ref={list} className={classes.field}>
      {there.map((branch, index) => (
        <OneCatch
          key={branch}
          branch={branch}
          number={several ? index + 1 : 0}
          onRemove={() => {
            remove(branch);
          }}
        />
      ))}
      <Button
        ref={add}
        variant="default"
        leftSection={<Plus size={15} aria-hidden="true" />}
        disabled={disabled || !added}
        onClick={addOne}
      >
        {t("try.add")}
      </Button>
      <p className={classes.now}>
        {several ? `${t("try.in_order")} ` : ""}
        {t(there.length > 0 ? "try.knows" : "try.goes_on")}
      </p>
    </div>
  );
}

/** The how manyth of those who have the step before them one is, from 0; the same in everybody's browser. */
function turnAt(people: readonly Person[], step: string): number {
  const me = people.find((person) => person.me);
  return me ? people.filter((each) => each.client < me.client && each.selection.includes(step)).length : 0;
}

/** One catch with what it takes; its number is 0 where it is the only one. */
function OneCatch({ branch, number, onRemove }: { branch: string; number: number; onRemove: () => void }) {
  const { t, scene } = useOpenProgram();
  const { id, step, set, disabled } = useStepEditor();
  const field = kindsOf(branch);
  const label = useId();
  const given = step.params[field];
  const kinds = Array.isArray(given) ? given.map(String) : [];
  const filled = scene.tree.children(id, branch).length > 0;
  const says = number === 0 ? t("try.label") : t("try.nth", { number });
  const none = t(number > 1 ? "try.rest" : "try.any");
  return (
    <div data-catch={branch}>
      <FieldFrame label={says} field={field}>
        {() => (
          <>
            <Checkbox.Group
              id={label}
              role="group"
              aria-label={says}
              description={kinds.length === 0 ? none : undefined}
              value={kinds}
              onChange={(next) => {
                set(
                  field,
                  KINDS.filter((kind) => next.includes(kind)),
                );
              }}
            >
              <div className={classes.choices}>
                {KINDS.map((kind) => (
                  <Checkbox key={kind} value={kind} label={t(`try.${kind}`)} disabled={disabled} />
                ))}
              </div>
            </Checkbox.Group>
            <Button
              variant="default"
              size="xs"
              leftSection={<Minus size={15} aria-hidden="true" />}
              disabled={disabled || filled}
              onClick={onRemove}
            >
              {number === 0 ? t("try.remove") : t("try.remove_nth", { number })}
            </Button>
            {filled ? <p className={classes.now}>{t("try.empty_first")}</p> : null}
          </>
        )}
      </FieldFrame>
    </div>
  );
}
