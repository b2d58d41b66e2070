/** One of the zones of the program; drawing a new one is a tool of its own. */
import { Select } from "@mantine/core";
import { textOf } from "@/program/document/document";
import { useOpenProgram } from "../../state/context";
import classes from "../../panel.module.css";
import { FieldFrame } from "./FieldFrame";
import { useStepEditor } from "./stepEditor";

export function ZoneField({ label, field }: { label: string; field: string }) {
  const { document, t } = useOpenProgram();
  const { step, set, disabled } = useStepEditor();
  const zones = Object.entries(document.zones).map(([id, zone]) => ({ value: id, label: String(zone.name || id) }));
  return (
    <FieldFrame label={label} field={field}>
      {({ control, note, bad }) => (
        <>
          <Select
            id={control}
            data={zones}
            value={textOf(step.params[field]) || null}
            placeholder={t("field.choose_zone")}
            onChange={(zone) => set(field, zone)}
            disabled={disabled}
            error={bad}
            aria-describedby={bad ? note : undefined}
          />
          {zones.length === 0 ? <p className={classes.now}>{t("field.no_zones")}</p> : null}
        </>
      )}
    </FieldFrame>
  );
}
