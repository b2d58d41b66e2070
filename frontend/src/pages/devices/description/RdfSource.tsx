import { NativeSelect, Skeleton } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { keys } from "@/api/queries";
import type { DescriptionForm } from "@/api/types";
import { LoadProblem } from "@/shell/LoadProblem";
import { Panel } from "@/design/Panel";
import { SourceView } from "./SourceView";
import type { Dialect } from "./source";
import styles from "../detail.module.css";

/** How each form is coloured. */
const DIALECTS: Readonly<Record<DescriptionForm, Dialect>> = {
  turtle: "turtle",
  "n-triples": "turtle",
  "json-ld": "json",
  td: "json",
  paper: "message",
};
const FORMS = Object.keys(DIALECTS) as DescriptionForm[];

/** Where a device's description can be read in a form. */
function rdfPath(slug: string, device: string, format: DescriptionForm): string {
  return `/sites/${slug}/devices/${encodeURIComponent(device)}/rdf?format=${format}`;
}

/** JSON is spread over lines; the rest stays as it is. */
function laidOut(text: string, format: DescriptionForm): string {
  return DIALECTS[format] === "json" ? JSON.stringify(JSON.parse(text), null, 2) : text;
}

export function RdfSource({ slug, device }: { slug: string; device: string }) {
  const { t } = useTranslation();
  const [format, setFormat] = useState<DescriptionForm>("turtle");
  const rdf = useQuery({
    queryKey: [...keys.rdf(slug, device), format],
    queryFn: async () => laidOut(await api.text(rdfPath(slug, device, format)), format),
  });
  return (
    <Panel className={styles.rdf}>
      <div className={styles.cardHead}>
        <h3>{t("pages.devices.rdf")}</h3>
        <NativeSelect
          size="xs"
          data={FORMS.map((form) => ({ value: form, label: t(`pages.devices.form.${form}`) }))}
          value={format}
          onChange={(event) => setFormat(event.currentTarget.value as DescriptionForm)}
          aria-label={t("pages.devices.rdfForm")}
        />
      </div>
      {rdf.isPending ? <Skeleton height={240} /> : null}
      {rdf.isError ? <LoadProblem error={rdf.error} again={() => void rdf.refetch()} /> : null}
      {rdf.data ? <SourceView text={rdf.data} dialect={DIALECTS[format]} label={t("pages.devices.rdf")} /> : null}
    </Panel>
  );
}
