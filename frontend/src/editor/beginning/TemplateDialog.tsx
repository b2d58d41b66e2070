/** Programs to begin with: each bound to the site's own devices, and seen on the site's own map before it is taken. */
import { Button, Modal, Select } from "@mantine/core";
import { useMemo, useState } from "react";
import { useTranslation } from "react-i18next";
import { VipoIcon } from "@/design/VipoIcon";
import { drawPasted } from "../script/pastedScript";
import { useOpenProgram } from "../state/context";
import { useUi } from "../state/ui";
import classes from "./beginning.module.css";
import { TemplatePreview } from "./TemplatePreview";
import { type Bound, type Chosen, filled, lacking, type Slot, type Template, TEMPLATES } from "./templates";

const close = () => useUi.setState({ dialog: null });

export function TemplateDialog() {
  const { t } = useTranslation();
  const opened = useUi((ui) => ui.dialog === "templates");
  return (
    <Modal opened={opened} onClose={close} title={t("first.templates.title")} size={1080}>
      <Templates />
    </Modal>
  );
}

function useTemplateSite() {
  const { devices, plan } = useOpenProgram();
  return useMemo(() => ({ devices, places: plan?.places ?? [] }), [devices, plan]);
}

function Templates() {
  const site = useTemplateSite();
  const lacks = TEMPLATES.map((each) => lacking(each.slots(site, {})));
  const first = TEMPLATES[Math.max(0, lacks.indexOf(null))];
  const [wanted, setWanted] = useState(first?.id);
  const template = TEMPLATES.find(({ id }) => id === wanted);
  return (
    <div className={classes.templates}>
      <Choice lacks={lacks} wanted={wanted} onChoose={setWanted} />
      {template ? <ChosenTemplate key={template.id} template={template} /> : null}
    </div>
  );
}

function Choice(props: {
  lacks: readonly (Slot | null)[];
  wanted: string | undefined;
  onChoose: (id: string) => void;
}) {
  const { t } = useTranslation();
  return (
    <fieldset className={classes.list}>
      <legend className="visually-hidden">{t("first.templates.title")}</legend>
      {TEMPLATES.map(({ id, icon }, index) => {
        const lack = props.lacks[index];
        return (
          <label key={id} className={classes.template}>
            <input
              type="radio"
              name="template"
              value={id}
              checked={id === props.wanted}
              onChange={() => props.onChoose(id)}
            />
            <VipoIcon name={icon} size={20} />
            <span>
              <b>{t(`first.templates.${id}.name`)}</b>
              <small>{lack ? t(`first.templates.lacks.${lackOf(lack)}`) : t(`first.templates.${id}.about`)}</small>
            </span>
          </label>
        );
      })}
    </fieldset>
  );
}

/** Stops of a patrol lack the same thing, whichever it is. */
function lackOf({ name }: Slot): string {
  return name.replace(/\d+$/, "");
}

function ChosenTemplate({ template }: { template: Template }) {
  const { t } = useTranslation();
  const site = useTemplateSite();
  const [chosen, setChosen] = useState<Chosen>({});
  const slots = useMemo(() => template.slots(site, chosen), [template, site, chosen]);
  const lack = lacking(slots);
  const bound = useMemo(() => (lack ? null : template.bind(site, chosen)), [template, site, chosen, lack]);
  if (!bound) return <p className={classes.lack}>{lack ? t(`first.templates.lacks.${lackOf(lack)}`) : null}</p>;
  return (
    <section className={classes.chosen} aria-label={t(`first.templates.${template.id}.name`)}>
      <TemplatePreview bound={bound} round={template.id === "patrol"} />
      <div className={classes.slots}>
        {slots.map((slot) => (
          <Select
            key={slot.name}
            label={t(`first.templates.slot.${slot.name}`)}
            data={slot.candidates.map(({ id, name }) => ({ value: id, label: name }))}
            value={filled(slots, slot.name, chosen)?.id ?? null}
            onChange={(id) => setChosen(id ? { ...chosen, [slot.name]: id } : chosen)}
            allowDeselect={false}
          />
        ))}
      </div>
      <Does bound={bound} />
      <Take bound={bound} />
    </section>
  );
}

function Does({ bound }: { bound: Bound }) {
  const { t } = useTranslation();
  return (
    <ol className={classes.does} aria-label={t("first.templates.list")}>
      {bound.does.map(({ key, values }, index) => (
        <li key={index}>{t(`first.templates.does.${key}`, values)}</li>
      ))}
    </ol>
  );
}

function Take({ bound }: { bound: Bound }) {
  const { t } = useTranslation();
  const open = useOpenProgram();
  const [busy, setBusy] = useState(false);
  const take = async () => {
    setBusy(true);
    await drawPasted(open, bound.script, new Map(), t("first.templates.taken"));
    setBusy(false);
    close();
  };
  return (
    <Button loading={busy} disabled={!open.compiled} onClick={() => void take()} className={classes.take}>
      {t("first.templates.take")}
    </Button>
  );
}
