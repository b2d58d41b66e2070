/** What VIPO would make of a description, before any device sends it. */
import { Button, Textarea } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { CircleCheck, OctagonAlert } from "lucide-react";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import type { Fault } from "@/api/types";
import type { DescriptionLook } from "@/api/types";
import type { Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { faultPlace, faultsWords, faultWords, isKnownFault } from "@/i18n/faults";
import styles from "./enrolment.module.css";

export function CheckDescription({ site }: { site: Site }) {
  const { t } = useTranslation();
  const [text, setText] = useState("");
  const look = useMutation({
    mutationFn: () => api.post<DescriptionLook>(`/sites/${site.slug}/describe`, { text }),
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    look.mutate();
  };
  return (
    <form onSubmit={submit} className={styles.stack}>
      <Textarea
        label={t("adding.description")}
        description={t("adding.descriptionHelp")}
        classNames={{ input: styles.source }}
        rows={10}
        spellCheck={false}
        value={text}
        onChange={(event) => {
          setText(event.target.value);
          look.reset();
        }}
      />
      <Button type="submit" className={styles.go} disabled={!text.trim()} loading={look.isPending}>
        {t("adding.check")}
      </Button>
      <div role="status">
        {look.data ? <Found look={look.data} /> : null}
        {look.isError ? <p className={styles.problem}>{problemText(look.error, t("shell.problem.screen"))}</p> : null}
      </div>
    </form>
  );
}

function Found({ look }: { look: DescriptionLook }) {
  const { t } = useTranslation();
  if (!look.description || !look.form) return <Faults faults={look.faults} />;
  const { name, id, kind, methods } = look.description;
  const can = methods.map((method) => method.name).join(", ");
  return (
    <>
      <p className={styles.good}>
        <CircleCheck size={16} aria-hidden="true" />
        {t("adding.good", {
          form: t(`pages.devices.form.${look.form}`),
          kind: t(`pages.devices.kind.${kind}`),
          name,
          id,
        })}
      </p>
      {can ? <p className={styles.quiet}>{t("adding.can", { can })}</p> : null}
      {look.mended.map((note) => (
        <p key={`${note.line}:${note.text}`} className={styles.quiet}>
          {t("adding.mended", { note: faultsWords([note]) })}
        </p>
      ))}
    </>
  );
}

function Faults({ faults }: { faults: Fault[] }) {
  return (
    <ul className={styles.faults}>
      {faults.map((fault) => (
        <li key={`${fault.line}:${fault.column}:${fault.path}:${fault.text}`}>
          <OctagonAlert size={16} aria-hidden="true" />
          <span>
            {faultPlace(fault) ? <b>{faultPlace(fault)} </b> : null}
            {fault.path ? <code>{fault.path} </code> : null}
            <span lang={isKnownFault(fault) ? undefined : "en"}>{faultWords(fault)}</span>
          </span>
        </li>
      ))}
    </ul>
  );
}
