/** One device: its id, then its key and what to set it up with, then the moment in which it comes. */
import { Button, SegmentedControl, TextInput } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import { useState, type FormEvent } from "react";
import { useTranslation } from "react-i18next";
import { ApiProblem, api } from "@/api/client";
import type { ExpectedDevice } from "@/api/types";
import type { Site } from "@/api/types";
import { problemText } from "@/shell/LoadProblem";
import { SourceView } from "../description/SourceView";
import { CopyText } from "./CopyText";
import { DEVICE_SORTS, isLocal, setupOf, type DeviceSort } from "./setups";
import { Arrival } from "./Arrival";
import styles from "./enrolment.module.css";

const ID = /^[A-Za-z0-9_.-]{1,64}$/;

export function OneDevice({ site, close }: { site: Site; close: () => void }) {
  const [expected, setExpected] = useState<ExpectedDevice | null>(null);
  return expected ? <SetUp site={site} device={expected} close={close} /> : <Name site={site} then={setExpected} />;
}

function Name({ site, then }: { site: Site; then: (device: ExpectedDevice) => void }) {
  const { t } = useTranslation();
  const [id, setId] = useState("");
  const name = id.trim();
  const wrong = name !== "" && !ID.test(name);
  const add = useMutation({
    mutationFn: (again: boolean) => api.post<ExpectedDevice>(`/sites/${site.slug}/newcomers`, { id: name, again }),
    onSuccess: then,
  });
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (name && !wrong) add.mutate(false);
  };
  const hasKey = add.error instanceof ApiProblem && add.error.code === "already_reserved";
  const problem = add.isError ? problemText(add.error, t("shell.problem.screen")) : null;
  return (
    <form onSubmit={submit} className={styles.stack}>
      <p>{t("adding.oneText")}</p>
      <TextInput
        data-autofocus
        label={t("adding.id")}
        description={t("adding.idHelp")}
        placeholder="mixer-7"
        classNames={{ input: styles.mono }}
        maxLength={64}
        autoComplete="off"
        spellCheck={false}
        value={id}
        error={wrong ? t("adding.idWrong") : problem}
        onChange={(event) => {
          setId(event.target.value);
          add.reset();
        }}
      />
      <Button type="submit" className={styles.go} disabled={!name || wrong} loading={add.isPending}>
        {t("adding.makeKey")}
      </Button>
      {hasKey && (
        <Button variant="default" className={styles.go} onClick={() => add.mutate(true)}>
          {t("adding.makeAnother")}
        </Button>
      )}
    </form>
  );
}

/** What has to be known of a broker's address, if anything. */
function brokerNotes(t: ReturnType<typeof useTranslation>["t"], broker: string): string[] {
  if (!broker) return [t("adding.brokerUnknown")];
  return isLocal(broker) ? [t("adding.brokerLocal")] : [];
}

function SetUp({ site, device, close }: { site: Site; device: ExpectedDevice; close: () => void }) {
  const { t } = useTranslation();
  const [sort, setSort] = useState<DeviceSort>("esp32");
  const setup = setupOf(sort, device);
  return (
    <div className={styles.stack}>
      <p className={styles.once}>{t("adding.once", { id: device.id })}</p>
      <SegmentedControl
        fullWidth
        aria-label={t("adding.sort")}
        data={DEVICE_SORTS.map((each) => ({ value: each, label: t(`adding.sorts.${each}`) }))}
        value={sort}
        onChange={(value) => setSort(value)}
      />
      <div className={styles.setup}>
        <div className={styles.setupHead}>
          <b>{setup.file ?? t("adding.terminal")}</b>
          <CopyText value={setup.text} />
        </div>
        <SourceView text={setup.text} dialect={setup.dialect} label={setup.file ?? t("adding.terminal")} />
      </div>
      <p className={styles.quiet}>{[t(`adding.how.${sort}`), ...brokerNotes(t, device.broker)].join(" ")}</p>
      <Arrival site={site} id={device.id} close={close} />
    </div>
  );
}
