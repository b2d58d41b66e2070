/** A form that tells a device to carry out one of its methods, and shows what comes of it. */
import { Alert, Button, Modal, Select, Switch, TextInput } from "@mantine/core";
import { skipToken, useMutation, useQuery } from "@tanstack/react-query";
import { Play, Square } from "lucide-react";
import { type FormEvent, useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { api } from "@/api/client";
import { useOnce } from "@/api/once";
import { useDevices, useSiteMap } from "@/api/queries";
import type { Device, DeviceMethod, MethodCall, MethodParameter, Site } from "@/api/types";
import { NumberField } from "@/design/NumberField";
import { useReturnFocus } from "@/design/useReturnFocus";
import { unitSign } from "@/i18n/units";
import { problemText } from "@/shell/LoadProblem";
import { useTellUnseen } from "@/shell/refusal";
import { ownEntry } from "@/design/ownEntry";
import { type Argument, emptyForm, type Problem, readArguments, type Typed } from "./arguments";
import styles from "./call.module.css";
import { CallProgress } from "./CallProgress";

interface FieldProps {
  parameter: MethodParameter;
  choices: { value: string; label: string }[] | null;
  value: string | number | boolean;
  error: string | null;
  change: (value: string | number | boolean) => void;
}

function Field({ parameter, choices, value, error, change }: FieldProps) {
  const { t } = useTranslation();
  const { name, type, minimum, maximum, unit } = parameter;
  const range = minimum !== null && maximum !== null ? t("pages.devices.range", { minimum, maximum }) : "";
  const common = { label: name, error, withAsterisk: parameter.required };
  if (type === "boolean")
    return <Switch label={name} checked={value === true} onChange={(event) => change(event.currentTarget.checked)} />;
  if (choices)
    return (
      <Select {...common} searchable data={choices} value={String(value) || null} onChange={(v) => change(v ?? "")} />
    );
  if (type === "number")
    return (
      <NumberField
        {...common}
        value={typeof value === "boolean" ? "" : value}
        description={[unitSign(unit), range].filter(Boolean).join(", ") || undefined}
        onChange={change}
      />
    );
  const hint = type === "location" ? t("device.try.locationHint") : undefined;
  return (
    <TextInput
      {...common}
      maxLength={256}
      value={String(value)}
      description={hint}
      onChange={(event) => change(event.target.value)}
    />
  );
}

/** What can be chosen for a parameter: its options, the site's devices or places, or what the device deals in. */
function useChoices(site: Site, device: Device) {
  const devices = useDevices(site.slug).data ?? [];
  const places = useSiteMap(site.has_map ? site.slug : undefined).data?.places ?? [];
  const objects = [...new Set([...device.gives, ...device.takes])];
  return ({ type, options }: MethodParameter) => {
    if (options?.length) return options.map((each) => ({ value: String(each), label: String(each) }));
    if (type === "object" && objects.length > 0) return objects.map((each) => ({ value: each, label: each }));
    if (type === "place") return places.map(({ id, name }) => ({ value: id, label: name }));
    const known = devices.filter((each) => each.lifecycle === "approved");
    return type === "device" ? known.map(({ id, name }) => ({ value: id, label: name })) : null;
  };
}

/** A button that is disabled would let the focus fall out of the dialog: Start stays one that does nothing. */
function Buttons({ busy, cancel }: { busy: boolean; cancel: (() => void) | null }) {
  const { t } = useTranslation();
  const start = useRef<HTMLButtonElement>(null);
  const offered = useRef(false);
  useEffect(() => {
    if (cancel) offered.current = true;
    else if (offered.current && document.activeElement === document.body) start.current?.focus();
  }, [cancel]);
  return (
    <div className={styles.buttons}>
      {cancel ? (
        <Button variant="default" leftSection={<Square size={14} aria-hidden="true" />} onClick={cancel}>
          {t("device.try.cancel")}
        </Button>
      ) : null}
      <Button
        ref={start}
        type="submit"
        aria-disabled={busy}
        data-disabled={busy || undefined}
        leftSection={<Play size={15} aria-hidden="true" />}
      >
        {t("device.try.start")}
      </Button>
    </div>
  );
}

interface TryMethodProps {
  site: Site;
  device: Device;
  method: DeviceMethod;
  onClose: () => void;
}

export function TryMethod({ site, device, method, onClose }: TryMethodProps) {
  const { t } = useTranslation();
  useReturnFocus();
  const choicesOf = useChoices(site, device);
  const [typed, setTyped] = useState<Typed>(() => emptyForm(method));
  const [problems, setProblems] = useState<Readonly<Record<string, Problem>>>({});
  const { start, cancel, call } = useCall(site.slug, device.id);
  const busy = start.isPending || (call !== null && !call.over);
  const isEnding = cancel.isPending || (cancel.isSuccess && cancel.variables === call?.id);
  const submit = (event: FormEvent) => {
    event.preventDefault();
    if (busy) return;
    const read = readArguments(method, typed);
    setProblems("problems" in read ? read.problems : {});
    if ("args" in read) start.mutate({ method: method.name, args: read.args });
  };
  const problemOf = ({ name, minimum, maximum }: MethodParameter) => {
    const problem = ownEntry(problems, name);
    return problem ? t(`device.try.problem.${problem}`, { minimum, maximum }) : null;
  };
  return (
    <Modal
      opened
      onClose={onClose}
      title={t("device.try.title", { device: device.name, method: method.name })}
      size={440}
    >
      <form onSubmit={submit} className={styles.form} noValidate>
        {method.parameters.length === 0 ? <p>{t("device.try.noParameters")}</p> : null}
        {method.parameters.map((parameter) => (
          <Field
            key={parameter.name}
            parameter={parameter}
            choices={choicesOf(parameter)}
            value={ownEntry(typed, parameter.name) ?? ""}
            error={problemOf(parameter)}
            change={(value) => setTyped((before) => ({ ...before, [parameter.name]: value }))}
          />
        ))}
        <p className={styles.warning}>{t("device.try.warning", { device: device.name })}</p>
        {start.isError ? (
          <Alert color="red" role="alert">
            {problemText(start.error, t("shell.problem.screen"))}
          </Alert>
        ) : null}
        {cancel.isError && cancel.variables === call?.id ? (
          <Alert color="red" role="alert">
            {problemText(cancel.error, t("shell.problem.screen"))}
          </Alert>
        ) : null}
        {call ? <CallProgress call={call} /> : null}
        <Buttons busy={busy} cancel={busy && call && !isEnding ? () => cancel.mutate(call.id) : null} />
      </form>
    </Modal>
  );
}

const FOLLOW_MS = 500;

export interface Order {
  readonly method: string;
  readonly args: Readonly<Record<string, Argument>>;
}

/** `call` is what was asked for last, as it is now; null before. */
export function useCall(slug: string, device: string) {
  const begin = useOnce();
  const onError = useTellUnseen();
  const start = useMutation({
    onError,
    mutationFn: (order: Order) => begin<MethodCall>(`/sites/${slug}/devices/${encodeURIComponent(device)}/call`, order),
  });
  const path = start.data ? `/sites/${slug}/calls/${start.data.id}` : null;
  const followed = useQuery({
    queryKey: ["call", start.data?.id],
    queryFn: path ? () => api.get<MethodCall>(path) : skipToken,
    refetchInterval: (query) => (query.state.data?.over ? false : FOLLOW_MS),
    staleTime: 0,
  });
  const cancel = useMutation({ mutationFn: (id: string) => api.post(`/sites/${slug}/calls/${id}/cancel`), onError });
  return { start, cancel, call: start.data ? (followed.data ?? start.data) : null };
}
